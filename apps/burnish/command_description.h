// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

namespace burnish::cli {

/// These functions describe the command line for other programs. They read it from the parser, so a new option of a
/// verb appears in its --help, its manual page and the completions without further code.

/// A manual page, named so that man finds it ("burnish-fit.1").
struct ManualPage {
  std::string name;
  std::string text;  ///< roff with the macros of man(7)
};

/// Returns a page of the program and one of each verb. A verb's page holds the verbs below it. `version` is printed at
/// the foot.
std::vector<ManualPage> manual_pages(const CLI::App& app, std::string_view version);

/// Returns the contents of --help for all verbs: name, description, examples, arguments (names, value, choices,
/// default, description), verbs.
nlohmann::ordered_json description_json(const CLI::App& app);

/// Returns a script that bash sources. It completes verbs, options, and the values of an option that takes one of a
/// few; elsewhere it completes files.
std::string bash_completion(const CLI::App& app);

/// Returns the same as a function that zsh autoloads as _burnish. It shows each option with its description.
std::string zsh_completion(const CLI::App& app);

}  // namespace burnish::cli
