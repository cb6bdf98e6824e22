// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include <burnish/power/power.h>

namespace burnish::cli {

// The subcommands of `specular`, in specular_numbers.cpp and specular_pictures.cpp.
void add_specular_table(CLI::App& verb);
void add_specular_eval(CLI::App& verb);
void add_specular_list(CLI::App& verb);
void add_specular_choose(CLI::App& verb);
void add_specular_code(CLI::App& verb);
void add_specular_plot(CLI::App& verb);
void add_specular_report(CLI::App& verb);

/// Returns the members of these names; an unknown name is a misuse.
std::vector<PowerMethod> parse_methods(const std::vector<std::string>& names);

/// The destination of a verb's text: a file, or standard output where `output` is empty. `json` prints JSON.
struct TextOutput {
  std::string output;
  bool json = false;
};
void add_text_output(CLI::App& verb, TextOutput& to);

/// Writes the text. With --json it also prints `about`, with the file's name as "output". Without a file, the JSON
/// holds the text under the name `what`.
void write_text(const TextOutput& to, const std::string& what, const std::string& text,
                nlohmann::ordered_json about);

}  // namespace burnish::cli
