// SPDX-License-Identifier: Apache-2.0
#include "fit_arguments.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/book/book_file.h>
#include <burnish/file.h>
#include <burnish/fitting/baselines/baselines.h>

#include "usage.h"

namespace burnish::cli {

namespace {

std::string word_of(const FitOption& option) {
  return spelled(option, FitFront::command_line);
}

// Returns the sentence of the option's row. In parentheses follow the option that it needs and its default, where these
// are short. The guide's page (docs/guide/fit-options.md) has them all, and the exclusions.
std::string description(const FitOption& option) {
  constexpr std::ptrdiff_t kMostWords = 25;
  std::string text(option.help), more;
  const auto add = [&](const std::string& what) {
    const std::string longer = more.empty() ? what : more + "; " + what;
    if (std::ranges::count(text + ' ' + longer, ' ') < kMostWords) more = longer;
  };
  if (!option.needs.empty()) add("needs " + word_of(fit_option(option.needs)));
  if (!option.left_out.empty()) add(fmt::format("default: {}", option.left_out));
  if (more.empty()) return text;
  if (text.ends_with('.')) text.pop_back();
  return fmt::format("{} ({}).", text, more);
}

// Returns a type name in CLI11's form, which completions and manual pages read: "TEXT:{image,relative}", "NUMBER:from 1
// to 64".
std::string type_name(const FitOption& option) {
  if (option.name == "method") return fmt::format("TEXT:{{{}}}", fmt::join(baseline_methods(), ","));
  switch (option.takes) {
    case FitValue::choice:
      return fmt::format("TEXT:{{{}}}", fmt::join(option.choices, ","));
    case FitValue::whole:
    case FitValue::number:
      return "NUMBER:" + range_text(option);
    case FitValue::bytes:
      return "BYTES:as 2700, 16K or auto";
    case FitValue::smoothness:
      return "NUMBER:or auto";
    case FitValue::file:
      return "FILE";
    default:
      return "TEXT";
  }
}

}  // namespace

bool FitArguments::given(const std::string& name) const {
  const auto texts = words.find(name);
  const auto flag = flags.find(name);
  return (texts != words.end() && !texts->second.empty()) || (flag != flags.end() && flag->second);
}

void add_fit_arguments(CLI::App& verb, FitArguments& arguments) {
  for (const FitOption& option : fit_option_table()) {
    const std::string name(option.name);
    if (option.takes == FitValue::flag) {
      verb.add_flag(word_of(option), arguments.flags[name], description(option));
      continue;
    }
    const std::string also = option.other_word.empty() ? "" : fmt::format(",{}", option.other_word);
    CLI::Option* added = verb.add_option(word_of(option) + also, arguments.words[name], description(option));
    added->type_name(type_name(option))->default_str(std::string(option.standard));
    if (option.takes == FitValue::texts)
      added->allow_extra_args(false);
    else
      added->expected(1);
  }
}

FitRequest request_of(const FitArguments& arguments) {
  std::vector<std::pair<std::string, std::string>> words;
  for (const auto& [name, texts] : arguments.words)
    for (const std::string& text : texts) words.emplace_back(name, text);
  for (const auto& [name, turned] : arguments.flags)
    if (turned) words.emplace_back(name, "");
  FitRequest request = usage([&] { return request_of_words(words); });
  if (arguments.given("book"))
    request.book =
        std::make_shared<const MaterialBook>(parse_book(read_file(arguments.words.at("book").front())));
  return request;
}

}  // namespace burnish::cli
