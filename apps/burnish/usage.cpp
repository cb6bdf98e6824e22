// SPDX-License-Identifier: Apache-2.0
#include "usage.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <burnish/io/formats.h>
#include <burnish/math/closest_name.h>

namespace burnish::cli {

namespace {

std::vector<std::string> verbs_of(const CLI::App& app, bool hidden_too) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!verb->get_name().empty() && (hidden_too || !verb->get_group().empty()))
      names.push_back(verb->get_name());  // an empty name is a group of options
  return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const CLI::App* group : app.get_subcommands([](const CLI::App* a) { return a->get_name().empty(); }))
    for (std::string& name : options_of(*group)) names.push_back(std::move(name));
  return names;
}

// Returns the option in a word such as --name=value or -nvalue. Numbers are no options.
std::string option_of(std::string_view word) {
  if (word.starts_with("--")) return std::string(word.substr(0, word.find('=')));
  const bool is_short =
      word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
  return std::string(is_short ? word.substr(0, 2) : "");
}

// Returns the message for a word that is no verb: the verb that it may have meant, or all of them.
std::string expected_verb(const std::vector<std::string>& verbs, std::string_view word) {
  const bool is_topic = word == "formats" || word == "models";
  const std::string meant =
      is_topic ? fmt::format("; did you mean 'help {}'?", word) : suggestion(word, verbs);
  return meant.empty() ? fmt::format("expected a verb ({}), found '{}'", fmt::join(verbs, ", "), word)
                       : fmt::format("expected a verb, found '{}'{}", word, meant);
}

}  // namespace

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  return did_you_mean(word, views);
}

namespace {

CLI::Validator number_that(const char* expected, const char* description, bool (*is)(double)) {
  const auto check = [=](std::string& value) {
    double number = 0;
    return CLI::detail::lexical_cast(value, number) && std::isfinite(number) && is(number)
               ? std::string()
               : fmt::format("expected {}, found '{}'", expected, value);
  };
  return {check, description};
}

}  // namespace

CLI::Validator at_least_zero() {
  return number_that("a number of at least 0", "NONNEGATIVE", [](double x) { return x >= 0; });
}
CLI::Validator above_zero() {
  return number_that("a number above 0", "POSITIVE", [](double x) { return x > 0; });
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

void check_folder(const std::filesystem::path& folder) {
  std::error_code none;
  std::filesystem::path there = std::filesystem::absolute(folder, none);
  while (!std::filesystem::exists(there, none) && there.has_relative_path()) there = there.parent_path();
  if (!std::filesystem::is_directory(there, none))
    throw Error::in_file(folder.string(), "a folder",
                         fmt::format("'{}', which is no folder", there.string()));
  if (::access(there.c_str(), W_OK | X_OK) != 0)
    throw Error::in_file(folder.string(), "a folder that can be written",
                         std::generic_category().message(errno));
}

namespace {

// Endings of other programs' files and of exports. Together with those of formats they tell a file's kind, so no other
// kind of file may have them.
constexpr auto kOtherEndings = std::to_array<std::string_view>(
    {".bmp", ".c",   ".cpp",   ".cube", ".dds",    ".gif",  ".glb",  ".glsl",  ".gltf",
     ".h",   ".hdr", ".hlsl",  ".html", ".jpeg",   ".jpg",  ".js",   ".jsonl", ".ktx2",
     ".md",  ".mdl", ".metal", ".mjs",  ".msl",    ".mtlx", ".obj",  ".pdf",   ".pfm",
     ".png", ".py",  ".rs",    ".spv",  ".sqlite", ".sv",   ".svg",  ".tif",   ".tiff",
     ".tsv", ".usd", ".usda",  ".usdz", ".v",      ".vert", ".frag", ".wgsl",  ".zip"});

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

bool is_known_ending(const std::string& ending) {
  if (ending == ".dat") return false;  // belongs to ALTA, and to many other programs
  return std::ranges::find(kOtherEndings, ending) != kOtherEndings.end() ||
         std::ranges::any_of(formats(), [&](const Format& format) {
           return std::ranges::count(endings_of(format), ending) > 0;
         });
}

}  // namespace

void check_ending(const std::string& path, const std::vector<std::string>& endings) {
  const std::string ending = ending_of(path);
  if (!is_known_ending(ending) || std::ranges::find(endings, ending) != endings.end()) return;
  throw CLI::ValidationError(
      fmt::format("--output: expected a name that ends in {}, found '{}'", fmt::join(endings, " or "), path));
}

void check_folder_name(const std::string& path) {
  if (std::error_code none; std::filesystem::exists(path, none) || !is_known_ending(ending_of(path))) return;
  throw CLI::ValidationError(fmt::format("--output: expected the name of a folder, found '{}'", path));
}

void check_no_empty_word(std::span<char* const> arguments) {
  for (std::size_t i = 1; i < arguments.size(); ++i)
    if (*arguments[i] == '\0')
      throw CLI::ValidationError(
          fmt::format("expected a name or a value after '{}', found an empty one", arguments[i - 1]));
}

std::string list_of_verbs(const CLI::App& app) {
  std::string text;
  for (const std::string& name : verbs_of(app, false))
    text += fmt::format("  {:<13}{}\n", name, app.get_subcommand(name)->get_description());
  return text +
         "\n"
         "`burnish VERB --help` shows its options and an example; `burnish help formats` lists the files "
         "that are read.\n";
}

std::optional<std::string> misspelling(const CLI::App& app, std::span<char* const> arguments) {
  const CLI::App* verb = &app;
  std::string path;
  bool within = false;  // true behind the last verb
  for (const std::string_view word : arguments) {
    if (word == "--") return std::nullopt;
    if (const std::string name = option_of(word); !name.empty()) {
      const std::vector<std::string> names = options_of(*verb);
      if (std::find(names.begin(), names.end(), name) == names.end())
        return fmt::format("{}expected an option, found '{}'{}", path, name,
                           name.starts_with("--") ? suggestion(name, names) : "");  // letters are all similar
    } else if (!within && !word.starts_with('-')) {
      const std::vector<std::string> verbs = verbs_of(*verb, true);
      if (verbs.empty()) {
        within = true;
        continue;
      }
      const auto found = std::find(verbs.begin(), verbs.end(), word);
      if (found == verbs.end()) return path + expected_verb(verbs_of(*verb, false), word);
      verb = verb->get_subcommand(*found);
      path += *found + ": ";
    }
  }
  const std::vector<std::string> verbs = verbs_of(*verb, false);
  if (verbs.empty()) return std::nullopt;
  return fmt::format("{}expected a verb ({}), found none", path, fmt::join(verbs, ", "));
}

}  // namespace burnish::cli
