// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/short_message.h>

namespace burnish {

Error::Error(const std::string& message) : std::runtime_error(short_message(message)) {}

Error::Error(const std::string& file, std::uint64_t offset, const std::string& expected,
             const std::string& found)
    : Error(fmt::format("{}: offset {}: expected {}, found {}", file, offset, expected, found)) {}

Error Error::in_line(const std::string& file, std::uint64_t line, const std::string& expected,
                     const std::string& found) {
  return Error(fmt::format("{}: line {}: expected {}, found {}", file, line, expected, found));
}

Error Error::in_file(const std::string& file, const std::string& expected, const std::string& found) {
  return Error(fmt::format("{}: expected {}, found {}", file, expected, found));
}

}  // namespace burnish
