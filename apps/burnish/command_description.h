#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

namespace burnish::cli {

/// What the parser knows of the command line, for other programs. Nothing is said twice: a new option of a verb is in
/// its --help, its manual page and the completions.

/// A manual page, named as man finds it ("burnish-fit.1").
struct ManualPage {
  std::string name;
  std::string text;  ///< roff with the macros of man(7)
};

/// One page of the program and one of each verb, which holds the verbs below it. `version` is printed at the foot.
std::vector<ManualPage> manual_pages(const CLI::App& app, std::string_view version);

/// What --help of a verb and of those below it says: name, description, examples, arguments (names, value, choices,
/// default, description), verbs.
nlohmann::ordered_json description_json(const CLI::App& app);

/// Completion of verbs, options, and values where an option takes one of a few; of files elsewhere.
/// A script that bash sources.
std::string bash_completion(const CLI::App& app);

/// The same as a function that zsh autoloads as _burnish; options come with what they do.
std::string zsh_completion(const CLI::App& app);

}  // namespace burnish::cli
