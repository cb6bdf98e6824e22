// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <span>

#include <fmt/core.h>

#include <burnish/error.h>
#include <burnish/short_message.h>

#include "commands.h"
#include "usage.h"

int main(int argc, char** argv) {
  CLI::App app{"burnish: measured, scattered or analytic reflectance into a few small positive textures"};
  app.require_subcommand(1);
  app.set_help_flag("-h,--help", "Prints this help.");
  bool as_json = false;  // parsed before --version is printed, since it is added first
  CLI::Option* const json = app.add_flag("--json", as_json, "Prints --version as JSON.");
  json->needs(app.set_version_flag(
      "--version", [&as_json] { return burnish::cli::version_text(as_json); },
      "Prints versions, instruction sets and threads."));
  burnish::cli::add_info_command(app);
  burnish::cli::add_fit_command(app);
  burnish::cli::add_batch_command(app);
  burnish::cli::add_book_command(app);
  burnish::cli::add_fit_surface_command(app);
  burnish::cli::add_eval_command(app);
  burnish::cli::add_compare_command(app);
  burnish::cli::add_measure_command(app);
  burnish::cli::add_convert_command(app);
  burnish::cli::add_export_command(app);
  burnish::cli::add_render_command(app);
  burnish::cli::add_specular_command(app);
  burnish::cli::add_hw_command(app);
  burnish::cli::add_describe_command(app);
  burnish::cli::add_help_command(app);
  try {
    burnish::cli::check_no_empty_word(std::span(argv, static_cast<std::size_t>(argc)));
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Every misuse exits with 2 and --help with 0. CLI11's own codes are not used.
    if (error.get_exit_code() == 0) return app.exit(error);
    if (argc == 1) {
      fmt::print(stderr, "burnish: expected a verb, found none; there are\n\n{}",
                 burnish::cli::list_of_verbs(app));
      return 2;
    }
    const auto meant =
        burnish::cli::misspelling(app, std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
    constexpr std::size_t kBesideHint = 245;  // keeps both lines together below 300 bytes
    fmt::print(stderr, "burnish: {}\nRun with --help for more information.\n",
               burnish::short_message(meant ? *meant : error.what(), kBesideHint));
    return 2;
  } catch (const burnish::Error& error) {
    fmt::print(stderr, "burnish: {}\n", burnish::short_message(error.what()));
    return 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish: {}\n", burnish::short_message(error.what()));
    return 1;
  }
  return 0;
}
