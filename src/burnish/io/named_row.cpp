// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/io/named_row.h>
#include <burnish/io/text_reader.h>

namespace burnish {

namespace {

constexpr std::size_t kNamesShown = 5, kMaxNameLength = 80;

std::string_view row_name(std::string_view line) noexcept {
  return trimmed(line.substr(0, line.find(',')));
}

std::vector<float> read_numbers(TextReader& reader, const NamedRowKind& kind) {
  reader.word();  // the name
  std::vector<float> numbers(kind.count);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<float>(reader.number(fmt::format("{} {}", kind.number, i + 1)));
  reader.end_of_line();
  return numbers;
}

std::string some_names(const std::vector<std::string>& names) {
  const auto shown = static_cast<std::ptrdiff_t>(std::min(names.size(), kNamesShown));
  return fmt::format(
      "{}{}", fmt::join(names.begin(), names.begin() + shown, ", "),
      names.size() > kNamesShown ? fmt::format(" and {} more", names.size() - kNamesShown) : "");
}

}  // namespace

NamedRow parse_named_row(const FileBytes& file, std::string_view name, const NamedRowKind& kind) {
  // Rows up to the wanted one are read.
  TextReader reader(file);
  std::vector<std::string> names;
  std::vector<float> numbers;
  while (numbers.empty() && reader.next_content_line()) {
    const std::string_view found = row_name(reader.line());
    names.push_back(printable(found, kMaxNameLength));
    if (found.empty() || found.find_first_of(" \t") != std::string_view::npos)
      reader.fail("a name without blanks", in_quotes(found));
    if (name.empty() ? names.size() == 1 : found == name) numbers = read_numbers(reader, kind);
  }

  // Without a name, the row has to be the only one.
  if (name.empty() && reader.next_content_line()) {
    do names.push_back(printable(row_name(reader.line()), kMaxNameLength));
    while (reader.next_content_line());
    throw Error::in_file(file.name, fmt::format("one {}, or a name: {}", kind.a_row, kind.address),
                         some_names(names));
  }
  if (numbers.empty())
    throw Error::in_file(file.name, fmt::format("an {} named {}", kind.a_row, in_quotes(name)),
                         names.empty() ? "no row" : some_names(names));
  return {names.back(), std::move(numbers)};
}

}  // namespace burnish
