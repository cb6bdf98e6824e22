#include "usage.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/math/closest_name.h>

namespace burnish::cli {

namespace {

constexpr std::size_t kLongestMessage = 290, kKeptEnd = 120;

std::vector<std::string> verbs_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

}  // namespace

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  return did_you_mean(word, views);
}

CLI::Validator one_of(std::vector<std::string> names) {
  std::string description = fmt::format("{{{}}}", fmt::join(names, ","));
  const auto check = [names = std::move(names)](std::string& value) {
    if (std::find(names.begin(), names.end(), value) != names.end()) return std::string();
    return fmt::format("expected one of {}, found '{}'{}", fmt::join(names, ", "), value,
                       suggestion(value, names));
  };
  return {check, std::move(description)};
}

std::string short_message(std::string_view message) {
  std::string line(message.substr(0, message.find_last_not_of("\r\n \t") + 1));
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  if (line.size() <= kLongestMessage) return line;
  // whole characters of UTF-8: no cut before a byte that continues one
  constexpr std::string_view kGap = " ... ";
  const auto continues = [&](std::size_t at) {
    return at < line.size() && (static_cast<unsigned char>(line[at]) & 0xc0) == 0x80;
  };
  std::size_t begin = kLongestMessage - kGap.size() - kKeptEnd, end = line.size() - kKeptEnd;
  while (begin > 0 && continues(begin)) --begin;
  while (continues(end)) ++end;
  return line.substr(0, begin) + std::string(kGap) + line.substr(end);
}

std::optional<std::string> misspelling(const CLI::App& app, std::span<char* const> arguments) {
  const CLI::App* verb = &app;
  std::string path;
  bool within = false;  // past the last verb
  for (const std::string_view word : arguments) {
    if (word == "--") return std::nullopt;
    if (word.starts_with("--")) {
      const std::string name(word.substr(0, word.find('=')));
      const std::vector<std::string> names = options_of(*verb);
      if (std::find(names.begin(), names.end(), name) == names.end())
        return fmt::format("{}expected an option, found '{}'{}", path, name, suggestion(name, names));
    } else if (!within && !word.starts_with('-')) {
      const std::vector<std::string> verbs = verbs_of(*verb);
      if (verbs.empty()) {
        within = true;
        continue;
      }
      const auto found = std::find(verbs.begin(), verbs.end(), word);
      if (found == verbs.end())
        return fmt::format("{}expected a verb, found '{}'{}", path, word, suggestion(word, verbs));
      verb = verb->get_subcommand(*found);
      path += *found + ": ";
    }
  }
  return std::nullopt;
}

}  // namespace burnish::cli
