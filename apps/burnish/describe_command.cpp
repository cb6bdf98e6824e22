// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <burnish/file.h>
#include <burnish/fitting/fit_request.h>
#include <burnish/library/folder_file.h>

#include "command_description.h"
#include "commands.h"
#include "json_output.h"

namespace burnish::cli {

void add_describe_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "describe", "Write the manual pages, completions and description of the command line, for packages");
  verb->group("");  // hidden from --help: the verb is for packagers of burnish
  verb->footer(
      "Examples: burnish describe -o share/man/man1\n"
      "          burnish describe --bash > /etc/bash_completion.d/burnish\n"
      "          burnish describe --zsh > \"${fpath[1]}/_burnish\"\n"
      "          burnish describe --json");
  struct Options {
    std::string man;
    bool bash = false, zsh = false, json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::Option_group* what = verb->add_option_group("what");
  what->require_option(1);
  what->add_option("-o,--output,--out,--man", options->man, "Writes manual pages into this folder.");
  what->add_flag("--bash", options->bash, "Prints the completion for bash.");
  what->add_flag("--zsh", options->zsh, "Prints the completion for zsh.");
  what->add_flag("--json", options->json,
                 "Prints all verbs, their options and examples as JSON, and the table of fit options.");
  verb->callback([&app, options] {
    if (options->bash) fmt::print("{}", bash_completion(app));
    if (options->zsh) fmt::print("{}", zsh_completion(app));
    if (options->json) {
      nlohmann::ordered_json description = description_json(app);
      description["fit_options"] = fit_options_json();
      print_as_json(description);
    }
    if (options->man.empty()) return;
    make_folder(options->man);
    for (const ManualPage& page : manual_pages(app, BURNISH_VERSION))
      write_then_rename(std::filesystem::path(options->man) / page.name, page.text);
  });
}

}  // namespace burnish::cli
