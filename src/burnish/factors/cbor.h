// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <burnish/file.h>

namespace burnish {

/// Returns true if a text is UTF-8, as CBOR's and JSON's texts are.
bool is_utf8(const std::string& text);

/// Writes items of CBOR [RFC8949] one after the other, lengths definite and heads as short as they can be.
class CborWriter {
 public:
  void integer(std::int64_t value);
  void text(std::string_view utf8);
  void bytes(std::span<const std::byte> content);
  /// Begins a list of the `count` items that follow.
  void list(std::size_t count);
  /// On the item that follows.
  void tag(std::uint64_t number);
  /// A finite number in the shortest spelling that holds it exactly: an integer, a half, single or double
  /// float, or a decimal fraction (tag 4).
  void number(double value);

  const std::string& written() const noexcept { return bytes_; }

 private:
  void head(int major, std::uint64_t value);

  std::string bytes_;
};

/// Reads items of CBOR front to back, each as what is expected there, from a file in memory. `what` names it
/// in errors. Every function throws Error, naming file and offset, where the file has something else, ends,
/// or holds an item of indefinite length. Nothing is nested but what the caller asks for.
class CborReader {
 public:
  explicit CborReader(const FileBytes& file) noexcept : file_(&file) {}

  std::uint64_t offset() const noexcept { return at_; }
  [[noreturn]] void fail(std::uint64_t offset, const std::string& expected, const std::string& found) const;

  /// An integer in [least, most].
  std::int64_t integer(std::string_view what, std::int64_t least, std::int64_t most);
  /// UTF-8 of at most `most` bytes.
  std::string text(std::string_view what, std::size_t most);
  /// A byte string of that length.
  std::span<const std::byte> bytes(std::string_view what, std::uint64_t length);
  /// The number of items of a list, in [least, most] and at most the bytes that are left.
  std::size_t list(std::string_view what, std::size_t least, std::size_t most);
  void tag(std::string_view what, std::uint64_t number);
  /// A finite number in any of CborWriter's spellings; decimal fractions to the nearest double.
  double number(std::string_view what);
  /// Returns true if a list comes next.
  bool list_is_next() const noexcept;
  /// Nothing may follow.
  void end() const;

 private:
  struct Head {
    std::uint64_t at = 0;  // offset of its first byte
    int major = 0, info = 0;
    std::uint64_t value = 0;
  };

  std::uint64_t remaining() const noexcept { return file_->bytes.size() - at_; }
  Head head(std::string_view what);
  std::span<const std::byte> take(std::string_view what, std::uint64_t count);
  [[noreturn]] void refuse(std::string_view what, const Head& found) const;
  double floating(std::string_view what, const Head& head) const;
  double decimal_fraction(std::string_view what, const Head& head);

  const FileBytes* file_;
  std::uint64_t at_ = 0;
};

}  // namespace burnish
