#include <exception>

#include <fmt/core.h>

#include <burnish/error.h>

#include "commands.h"

int main(int argc, char** argv) {
  CLI::App app{"burnish: measured, scattered or analytic reflectance into a few small positive textures"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "burnish " BURNISH_VERSION);
  burnish::cli::add_info_command(app);
  burnish::cli::add_fit_command(app);
  burnish::cli::add_eval_command(app);
  burnish::cli::add_compare_command(app);
  burnish::cli::add_measure_command(app);
  burnish::cli::add_convert_command(app);
  burnish::cli::add_export_command(app);
  burnish::cli::add_render_command(app);
  burnish::cli::add_specular_command(app);
  burnish::cli::add_hw_command(app);
  burnish::cli::add_describe_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // CLI11 returns its own codes; ours is 2 for every misuse, 0 for --help.
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const burnish::Error& error) {
    fmt::print(stderr, "burnish: {}\n", error.what());
    return 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish: {}\n", error.what());
    return 1;
  }
  return 0;
}
