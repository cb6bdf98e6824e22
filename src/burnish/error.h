// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace burnish {

/// Thrown for every kind of bad input: a file that is not what it claims to be, a parameter outside its
/// domain. what() is one short_message: "file: offset N: expected E, found F", with the parts that are known.
class Error : public std::runtime_error {
 public:
  /// Bad input that is no file (a parameter, an expression).
  explicit Error(const std::string& message);
  /// Bad content of `file` at byte `offset`.
  Error(const std::string& file, std::uint64_t offset, const std::string& expected, const std::string& found);
  /// Bad content of text `file` in line `line` (counted from 1).
  static Error in_line(const std::string& file, std::uint64_t line, const std::string& expected,
                       const std::string& found);
  /// Bad content of `file` as a whole.
  static Error in_file(const std::string& file, const std::string& expected, const std::string& found);
};

}  // namespace burnish
