// SPDX-License-Identifier: Apache-2.0
#include "specular_command.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <burnish/file.h>

#include "commands.h"
#include "json_output.h"
#include "usage.h"

namespace burnish::cli {

std::vector<PowerMethod> parse_methods(const std::vector<std::string>& names) {
  std::vector<PowerMethod> methods;
  for (const std::string& name : names) methods.push_back(usage([&] { return power_method(name); }));
  return methods;
}

void add_text_output(CLI::App& verb, TextOutput& to) {
  verb.add_option("-o,--output,--out", to.output, "Writes this file instead of the standard output.");
  verb.add_flag("--json", to.json, "Prints what was made as JSON.");
}

void write_text(const TextOutput& to, const std::string& what, const std::string& text,
                nlohmann::ordered_json about) {
  if (!to.output.empty()) write_then_rename(to.output, text);
  if (to.json) {
    about[to.output.empty() ? what : "output"] = to.output.empty() ? text : to.output;
    print_as_json(about);
  } else if (to.output.empty()) {
    fmt::print("{}", text);
  }
}

void add_specular_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("specular", "cos^exponent without pow: values, tables, code, figures");
  verb->require_subcommand(1);
  verb->footer(
      "Example: burnish specular choose --max-error 1/255 --exponents 1:1000\n"
      "         burnish specular code --method cubic2 --to glsl");
  add_specular_list(*verb);
  add_specular_choose(*verb);
  add_specular_code(*verb);
  add_specular_eval(*verb);
  add_specular_table(*verb);
  add_specular_plot(*verb);
  add_specular_report(*verb);
}

}  // namespace burnish::cli
