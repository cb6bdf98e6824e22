// SPDX-License-Identifier: Apache-2.0
#include "markdown.h"

#include <algorithm>
#include <cassert>
#include <fstream>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>

namespace burnish::reports {

namespace {

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\n") == cell.npos) return cell;
  std::string text = "\"";
  for (const char c : cell) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + '"';
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::vector<std::string> quoted_cells;
  for (const std::string& cell : cells) quoted_cells.push_back(quoted(cell));
  return fmt::format("{}\n", fmt::join(quoted_cells, ","));
}

// Returns nothing where a value is missing.
std::optional<std::string> filled(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string result;
  for (std::size_t at = 0;;) {
    const std::size_t begin = text.find('@', at), end = text.find('@', begin + 1);
    if (begin == text.npos || end == text.npos) return result.append(text.substr(at));
    const auto value = values.find(std::string(text.substr(begin + 1, end - begin - 1)));
    if (value == values.end()) return {};
    result.append(text.substr(at, begin - at)).append(value->second);
    at = end + 1;
  }
}

}  // namespace

void Table::add(std::vector<std::string> cells) {
  assert(cells.size() == head_.size());
  rows_.push_back(std::move(cells));
}

std::string Table::markdown() const {
  std::string text = fmt::format("| {} |\n|", fmt::join(head_, " | "));
  for (std::size_t i = 0; i < head_.size(); ++i) text += "---|";
  for (const auto& cells : rows_) text += fmt::format("\n| {} |", fmt::join(cells, " | "));
  return text;
}

std::string Table::csv() const {
  std::string text = csv_line(head_);
  for (const auto& cells : rows_) text += csv_line(cells);
  return text;
}

std::string fill_template(std::string_view text, const std::map<std::string, std::string>& values) {
  constexpr std::string_view kSection = "\n## ";
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t heading = text.find(kSection, at),
                      end = heading == text.npos ? text.size() : heading + 1;
    const std::string_view part = text.substr(at, end - at);
    const std::optional<std::string> section = filled(part, values);
    if (!section && !part.starts_with("## "))
      throw Error("template: expected values of its beginning, found none");
    result += section.value_or("");
    at = end;
  }
  return result;
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  std::string name = "unknown processor";
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      name = line.substr(line.find(':') + 2);
      break;
    }
  return fmt::format("{}, {} threads", name, std::thread::hardware_concurrency());
}

}  // namespace burnish::reports
