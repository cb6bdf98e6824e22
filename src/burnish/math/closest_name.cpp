// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/math/closest_name.h>

namespace burnish {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // rows of the table of all prefixes: the one before last, the last, the current one
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = last;
    last = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

namespace {

std::string in_lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace

std::string_view closest_name(std::string_view word, std::span<const std::string_view> names) {
  // no name is so long that a longer word could be one of it
  constexpr std::size_t kLongest = 64;
  if (word.size() > kLongest) return {};
  const std::string lower = in_lower_case(word);
  std::string_view closest;
  std::size_t least = std::max<std::size_t>(word.size() / 3, 1) + 1;
  for (const std::string_view name : names)
    if (const std::size_t distance = edit_distance(lower, in_lower_case(name)); distance < least) {
      least = distance;
      closest = name;
    }
  return closest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> names) {
  const std::string_view meant = closest_name(word, names);
  return meant.empty() ? std::string() : "; did you mean '" + std::string(meant) + "'?";
}

std::string expected_one_of(std::span<const std::string_view> names, std::string_view word) {
  return fmt::format("expected one of {}, found '{}'{}", fmt::join(names, ", "), word,
                     did_you_mean(word, names));
}

std::string listed(std::span<const std::string_view> names, std::string_view last_by) {
  return fmt::format("{} {} {}", fmt::join(names.first(names.size() - 1), ", "), last_by, names.back());
}

}  // namespace burnish
