// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <burnish/io/text_reader.h>

namespace burnish {

namespace {

constexpr std::string_view kSeparators = " \t,";

/// Returns the character that ends the lines of a text: \n, or \r alone on old systems.
char line_end_of(std::string_view text) noexcept {
  const std::size_t first = text.find_first_of("\r\n");
  return first != std::string_view::npos && text[first] == '\r' && !text.substr(first + 1).starts_with('\n')
             ? '\r'
             : '\n';
}

/// Cuts the first line off the text.
std::string_view take_line(std::string_view& text, char line_end) noexcept {
  const std::size_t end = std::min(text.find(line_end), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

bool is_content(std::string_view line) noexcept {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] != '#';
}

std::string_view without_mark(std::string_view text) noexcept {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

}  // namespace

TextReader::TextReader(const FileBytes& file) noexcept : TextReader(file.name, file.text()) {}

TextReader::TextReader(const std::string& name, std::string_view text) noexcept
    : name_(&name), rest_(without_mark(text)), line_end_(line_end_of(rest_)) {}

bool TextReader::next_line() noexcept {
  if (rest_.empty()) return false;
  line_ = unread_ = take_line(rest_, line_end_);
  ++line_number_;
  return true;
}

bool TextReader::next_content_line() noexcept {
  while (next_line())
    if (is_content(line_)) return true;
  return false;
}

std::string_view TextReader::word() noexcept {
  unread_.remove_prefix(std::min(unread_.find_first_not_of(kSeparators), unread_.size()));
  const std::string_view found = unread_.substr(0, unread_.find_first_of(kSeparators));
  unread_.remove_prefix(found.size());
  return found;
}

double TextReader::number(std::string_view what) {
  const std::string_view found = word();
  if (const auto value = parse_number(found)) return *value;
  fail(fmt::format("a finite number for {}", what), found.empty() ? "the end of the line" : in_quotes(found));
}

std::size_t TextReader::count(std::string_view what, std::size_t low, std::size_t high) {
  const std::string_view found = word();
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (error != std::errc{} || end != found.data() + found.size() || value < low || value > high)
    fail(fmt::format("{} in [{}, {}]", what, low, high), in_quotes(found));
  return value;
}

void TextReader::end_of_line() {
  if (const std::string_view found = word(); !found.empty()) fail("the end of the line", in_quotes(found));
}

void TextReader::fail(const std::string& expected, const std::string& found) const {
  throw Error::in_line(*name_, line_number_, expected, found);
}

std::optional<double> parse_number(std::string_view word) noexcept {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string_view trimmed(std::string_view text) noexcept {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

std::string printable(std::string_view text, std::size_t most) {
  std::string kept(text.substr(0, most));
  std::replace_if(
      kept.begin(), kept.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
  return kept;
}

std::string in_quotes(std::string_view text) {
  std::string printable(text.substr(0, 40));
  std::replace_if(
      printable.begin(), printable.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return fmt::format("'{}'", printable);
}

std::string_view first_content_line(std::string_view text) noexcept {
  text = without_mark(text.substr(0, 65536));
  const char line_end = line_end_of(text);
  while (!text.empty())
    if (const std::string_view line = take_line(text, line_end); is_content(line)) return line;
  return {};
}

}  // namespace burnish
