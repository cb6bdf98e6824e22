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

/// Members by name; an unknown one is a misuse.
std::vector<PowerMethod> parse_methods(const std::vector<std::string>& names);

/// What a verb gives as text: where it goes, standard output where `output` is empty, and whether JSON is printed.
struct TextOutput {
  std::string output;
  bool json = false;
};
void add_text_output(CLI::App& verb, TextOutput& to);

/// Writes it; with --json prints `about` with the file's name ("output"), or else with the text, under `what`.
void write_text(const TextOutput& to, const std::string& what, const std::string& text,
                nlohmann::ordered_json about);

}  // namespace burnish::cli
