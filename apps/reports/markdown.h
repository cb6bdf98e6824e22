// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace burnish::reports {

/// A table filled row by row. `add` expects as many cells as the head has.
class Table {
 public:
  explicit Table(std::vector<std::string> head) : head_(std::move(head)) {}

  void add(std::vector<std::string> cells);
  bool empty() const noexcept { return rows_.empty(); }

  std::string markdown() const;
  /// Returns CSV. Cells that hold a comma or quotes stand in quotes.
  std::string csv() const;

 private:
  std::vector<std::string> head_;
  std::vector<std::vector<std::string>> rows_;
};

/// Returns the cells of both, one after the other.
template <class Cells>
std::vector<std::string> joined(std::vector<std::string> first, const Cells& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

/// Formats each value with fmt's format, such as "{:.3f}".
template <class Values>
std::vector<std::string> cells(fmt::string_view format, const Values& values) {
  std::vector<std::string> texts;
  for (const auto& value : values) texts.push_back(fmt::format(fmt::runtime(format), value));
  return texts;
}

/// Fills a template: each @name@ becomes its value. A section goes from a line that begins with "## " to the next. It
/// is left out where a value that it names is missing. Throws Error where a value is missing elsewhere.
std::string fill_template(std::string_view text, const std::map<std::string, std::string>& values);

/// Describes the processor by its name in /proc/cpuinfo and its number of threads: "AMD EPYC, 2 threads".
std::string processor();

}  // namespace burnish::reports
