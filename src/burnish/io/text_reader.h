// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <burnish/io/byte_reader.h>

namespace burnish {

/// Reads a text file line by line and its lines word by word; errors name the line. Blanks, tabs and commas separate
/// words. A line ends at \n or \r\n, or at \r if the first line does. A UTF-8 byte order mark at the front is skipped.
class TextReader {
 public:
  explicit TextReader(const FileBytes& file) noexcept;
  /// Reads a text, which has to live as long as its `name`.
  TextReader(const std::string& name, std::string_view text) noexcept;

  /// Moves to the next line; returns false at the end of the file.
  bool next_line() noexcept;
  /// Moves to the next line that is neither blank nor a comment, which starts with '#'.
  bool next_content_line() noexcept;
  /// Returns the current line without its end.
  std::string_view line() const noexcept { return line_; }
  /// Returns the number of bytes after the current line.
  std::size_t remaining() const noexcept { return rest_.size(); }

  /// Returns the next word of the current line, empty at its end.
  std::string_view word() noexcept;
  /// Returns the next word as a finite number; throws Error if it is none.
  double number(std::string_view what);
  /// Returns the next word as a count; throws Error unless it is one in [low, high].
  std::size_t count(std::string_view what, std::size_t low, std::size_t high);
  /// Throws Error unless the current line holds no further word.
  void end_of_line();

  /// Throws Error at the current line.
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

 private:
  const std::string* name_;
  std::string_view rest_, line_, unread_;
  char line_end_;
  std::uint64_t line_number_ = 0;
};

/// Returns the finite number that is the whole of `word`, or nothing.
std::optional<double> parse_number(std::string_view word) noexcept;

/// Returns the text without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text) noexcept;

/// Returns the text with ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// Returns at most `most` bytes of a remark, control characters as '?'.
std::string printable(std::string_view text, std::size_t most);

/// Returns at most 40 characters in quotes for an error message, unprintable ones as '?'.
std::string in_quotes(std::string_view text);

/// Returns the first line within the first 64 KiB that is neither blank nor a '#' comment. Formats are
/// recognized by it.
std::string_view first_content_line(std::string_view text) noexcept;

}  // namespace burnish
