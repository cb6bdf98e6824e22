// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/capture/pictures/virtual_capture.h>
#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/io/csv.h>
#include <burnish/math/angles.h>
#include <burnish/math/written_degrees.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/next_measurements.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/reflectance/outliers.h>

#include "commands.h"
#include "counted.h"
#include "json_output.h"
#include "progress.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

void measure_surface(const std::string& scene, const std::string& out, bool json) {
  const std::filesystem::path path(scene);
  const CaptureForm form = [&] {
    Progress progress("pictures");
    return write_virtual_capture(parse_surface_scene(read_file(path), path.parent_path()), out,
                                 progress.bar());
  }();
  if (json)
    print_as_json({{"output", out},
                   {"width", form.width},
                   {"height", form.height},
                   {"pictures", form.pictures.size()}});
  else
    fmt::print("{} of {} x {} texels to {}\n", counted(form.pictures.size(), "picture"), form.width,
               form.height, out);
}

/// Returns the next directions in degrees, as CSV for an instrument.
std::string next_csv(std::span<const NextMeasurement> next) {
  std::string text = "theta_i,phi_i,theta_o,phi_o,error\n";
  for (const auto& [pair, error] : next)
    text +=
        fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.4g}\n", degrees(theta_of(pair.wi)),
                    degrees(phi_of(pair.wi)), degrees(theta_of(pair.wo)), degrees(phi_of(pair.wo)), error);
  return text;
}

nlohmann::ordered_json next_json(std::span<const NextMeasurement> next) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [pair, error] : next)
    list.push_back({{"theta_i_deg", written_degrees(theta_of(pair.wi))},
                    {"phi_i_deg", written_degrees(phi_of(pair.wi))},
                    {"theta_o_deg", written_degrees(theta_of(pair.wo))},
                    {"phi_o_deg", written_degrees(phi_of(pair.wo))},
                    {"error", error}});
  return list;
}

/// Lists the directions to measure next, in a file where one is given.
void say_next(const Source& source, std::size_t count, const std::string& out, bool json) {
  const MeasuredNodes all = measured_nodes(source), nodes = source.samples() ? without_outliers(all) : all;
  const std::vector<NextMeasurement> next = [&] {
    Progress progress("kriging");
    try {
      return next_measurements(nodes, choose_covariance(nodes, progress.bar()), count);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", source.name, error.what()));
    }
  }();
  if (!out.empty()) write_then_rename(out, next_csv(next));
  if (json) return print_as_json({{"next", next_json(next)}});
  if (!out.empty()) return fmt::print("{} to {}\n", counted(next.size(), "direction"), out);
  fmt::print("{}", next_csv(next));
}

}  // namespace

void add_measure_command(CLI::App& app) {
  struct Arguments {
    SourceArguments source;
    MeasureOptions measurement;
    std::string out, surface;
    std::size_t next = 0;
    bool json = false;
  };
  CLI::App* verb = app.add_subcommand("measure",
                                      "Measure a BRDF with a virtual goniometer: scattered samples as CSV; "
                                      "or a surface with a virtual camera");
  verb->footer(
      "Examples: burnish measure ggx:alpha_x=0.2 -o samples.csv --count 5000 --noise 0.05\n"
      "          burnish measure --surface scene.json -o capture/\n"
      "          burnish measure --next 20 samples.csv");
  auto arguments = std::make_shared<Arguments>();
  add_source_arguments(*verb, arguments->source);
  CLI::Option* const positional = verb->get_option("BRDF")->required(false);
  verb->add_option(
          "--surface", arguments->surface,
          "Writes a capture of this scene of materials, heights, lights and views (docs/guide/surfaces.md).")
      ->excludes(positional);
  CLI::Option* const next =
      verb->add_option("--next", arguments->next,
                       "Lists this many directions, in degrees, that lower a measurement's expected error "
                       "most, each with the error once those before are measured.")
          ->check(in_range(std::size_t{1}, kMostNext));
  verb->add_option("-o,--output,--out", arguments->out,
                   "Names the CSV file to write, with --surface the folder; only --next does without.");
  // The limit is ten million samples, which are a gigabyte of text.
  verb->add_option("--count", arguments->measurement.count, "Draws this many samples.")
      ->excludes(next)
      ->check(in_range(1, 10000000))
      ->capture_default_str();
  verb->add_option("--noise", arguments->measurement.noise,
                   "Adds log-normal noise of this sigma to every value.")
      ->excludes(next)
      ->check(in_range(0.0, 10.0))
      ->capture_default_str();
  verb->add_option("--seed", arguments->measurement.seed, "Chooses directions and noise.")
      ->check(at_least_zero())
      ->capture_default_str();
  verb->add_flag("--json", arguments->json, "Prints what was written as JSON.");
  verb->get_option("--surface")->excludes(next);
  verb->callback([arguments] {
    if (arguments->next == 0 && arguments->out.empty()) throw CLI::RequiredError("--output");
    if (!arguments->surface.empty()) check_folder_name(arguments->out);
    if (arguments->surface.empty() && !arguments->out.empty()) check_ending(arguments->out, {".csv", ".txt"});
    if (!arguments->surface.empty())
      return measure_surface(arguments->surface, arguments->out, arguments->json);
    if (arguments->source.spec.empty()) throw CLI::RequiredError("BRDF or --surface");
    if (!arguments->out.empty()) check_writable(arguments->out);
    const Source source = arguments->source.open();
    if (arguments->next > 0) return say_next(source, arguments->next, arguments->out, arguments->json);
    std::optional<Progress> progress(std::in_place, "measuring");
    const Samples samples = [&] {
      try {
        return measure(source.ref(), arguments->measurement);
      } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", arguments->source.spec, error.what()));
      }
    }();
    if (const auto stage = progress->stages()) stage("writing", 0);
    write_then_rename(arguments->out, samples_csv(samples, source.findings.lambda_nm));
    progress.reset();
    if (arguments->json)
      print_as_json(
          {{"output", arguments->out}, {"samples", samples.size()}, {"channels", samples.channels}});
    else
      fmt::print("{} samples to {}\n", samples.size(), arguments->out);
  });
}

}  // namespace burnish::cli
