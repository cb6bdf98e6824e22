#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

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

/// Writes `text` to a file, or to standard output where `path` is empty.
void write_text(const std::string& path, const std::string& text);

}  // namespace burnish::cli
