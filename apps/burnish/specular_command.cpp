#include "specular_command.h"

#include <fmt/core.h>

#include <burnish/file.h>

#include "commands.h"
#include "usage.h"

namespace burnish::cli {

std::vector<PowerMethod> parse_methods(const std::vector<std::string>& names) {
  std::vector<PowerMethod> methods;
  for (const std::string& name : names) methods.push_back(usage([&] { return power_method(name); }));
  return methods;
}

void write_text(const std::string& path, const std::string& text) {
  if (path.empty())
    fmt::print("{}", text);
  else
    write_then_rename(path, text);
}

void add_specular_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("specular", "cos^exponent without pow: values, tables, code, figures");
  verb->require_subcommand(1);
  verb->footer(
      "Example: burnish specular choose --max-error 1/255 --exponents 1:1000\n"
      "         burnish specular code --method cubic2 --lang glsl");
  add_specular_list(*verb);
  add_specular_choose(*verb);
  add_specular_code(*verb);
  add_specular_eval(*verb);
  add_specular_table(*verb);
  add_specular_plot(*verb);
  add_specular_report(*verb);
}

}  // namespace burnish::cli
