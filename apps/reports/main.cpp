// SPDX-License-Identifier: Apache-2.0
// burnish_reports NAME [OPTIONS] OUTPUT_FOLDER measures the figures of the pages in docs/results and writes the pages.
#include <cstdlib>
#include <exception>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "report.h"

namespace burnish::reports {

namespace {

struct Report {
  const char *name, *description;
  void (*run)(const ReportOptions& options);
  std::set<std::string> sections = {};
};

const Report kReports[] = {
    {"results", "the fit of one lobe: scattered samples, measurements, a table of the MERL size",
     report_results},
    {"accuracy",
     "what a number of bytes buys, beside other methods",
     report_accuracy,
     {"rgl", "merl", "others", "paints"}},
    {"measured",
     "what a model says of measured nodes, incidences and scans that it has not seen",
     report_measured,
     {"halves", "incidences", "repeat", "formats", "noise", "order", "scattered"}},
    {"cost", "error beside nanoseconds, fetches and milliseconds a frame, of fits and of other methods",
     report_cost},
    {"area-lights", "spheres under square lamps: tables of area lights beside samples", report_area_lights},
    {"sampling", "ways of drawing directions: weights, variance, time", report_sampling},
    {"shaders",
     "precision and cost of generated shaders, and light from all around",
     report_shaders,
     {"precision", "webgl", "cost", "environment"}},
    {"openpbr", "the OpenPBR fit beside the best of 200 random starts", report_openpbr, {"rgl", "merl"}},
    {"surfaces", "surfaces: milliseconds a frame beside a uniform model, and mip levels", report_surfaces},
    {"frame-cost", "milliseconds a frame beside other materials", report_frame_cost, {"page"}},
};

void add_report(CLI::App& app, const Report& report) {
  CLI::App* verb = app.add_subcommand(report.name, report.description);
  auto options = std::make_shared<ReportOptions>();
  verb->add_option("OUTPUT_FOLDER", options->folder, "of the page and its rows; figures go to ../figures")
      ->required();
  verb->add_flag("--quick", options->quick,
                 "few materials and repetitions: whether it runs, not what it gives");
  if (!report.sections.empty())
    verb->add_option("--section", options->section, "alone, in place of all")
        ->check(CLI::IsMember(report.sections));
  verb->callback([options, run = report.run] {
    if (const char* data = std::getenv("BURNISH_DATA")) options->data = data;
    if (const char* commit = std::getenv("BURNISH_COMMIT")) options->commit = commit;
    if (!options->data) tell("BURNISH_DATA is not set: no real materials");
    run(*options);
  });
}

void add_hardware_sphere(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("hardware-sphere", "a sphere shaded by units of hw/, pixel by pixel");
  verb->require_subcommand(1);
  auto unit = std::make_shared<std::string>();
  CLI::App* questions = verb->add_subcommand("questions", "Print what a simulated unit is to answer");
  questions->add_option("UNIT", *unit, "a shipped unit")->required();
  questions->callback([unit] { print_sphere_questions(*unit); });
  auto folder = std::make_shared<std::string>();
  auto answers = std::make_shared<std::vector<std::string>>();
  CLI::App* picture = verb->add_subcommand("picture", "Draw hardware_sphere.png, print largest differences");
  picture->add_option("OUTPUT_FOLDER", *folder, "of the picture")->required();
  picture->add_option("ANSWERS", *answers, "NAME=FILE of each unit")->required();
  picture->callback([folder, answers] { draw_sphere_answers(*folder, *answers); });
}

}  // namespace

}  // namespace burnish::reports

int main(int argc, char** argv) {
  CLI::App app{"Measures what the pages of docs/results state and writes them"};
  app.footer(
      "Real materials need the folder of measurements in the environment variable BURNISH_DATA and are "
      "left out without it. Pages name the commit that BURNISH_COMMIT says.\nExample: burnish_reports "
      "accuracy --quick /tmp/results");
  app.require_subcommand(1);
  for (const burnish::reports::Report& report : burnish::reports::kReports)
    burnish::reports::add_report(app, report);
  burnish::reports::add_hardware_sphere(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish_reports: {}\n", error.what());
    return 1;
  }
}
