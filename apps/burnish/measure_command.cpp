#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/capture/virtual_capture.h>
#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/io/csv.h>
#include <burnish/reflectance/goniometer.h>

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
  const CaptureForm form = write_virtual_capture(parse_surface_scene(read_file(path), path.parent_path()),
                                                 out, progress_bar("pictures"));
  if (json)
    print_as_json({{"output", out},
                   {"width", form.width},
                   {"height", form.height},
                   {"pictures", form.pictures.size()}});
  else
    fmt::print("{} of {} x {} texels to {}\n", counted(form.pictures.size(), "picture"), form.width,
               form.height, out);
}

}  // namespace

void add_measure_command(CLI::App& app) {
  struct Arguments {
    SourceArguments source;
    MeasureOptions measurement;
    std::string out, surface;
    bool json = false;
  };
  CLI::App* verb = app.add_subcommand("measure",
                                      "Measure a BRDF with a virtual goniometer: scattered samples as CSV; "
                                      "or a surface with a virtual camera");
  verb->footer(
      "Examples: burnish measure ggx:alpha_x=0.2 -o samples.csv --count 5000 --noise 0.05\n"
      "          burnish measure --surface scene.json -o capture/");
  auto arguments = std::make_shared<Arguments>();
  add_source_arguments(*verb, arguments->source);
  CLI::Option* const positional = verb->get_option("BRDF")->required(false);
  verb->add_option(
          "--surface", arguments->surface,
          "a scene of materials, heights, lights and views (docs/guide/surfaces.md): writes a capture")
      ->excludes(positional);
  verb->add_option("-o,--output,--out", arguments->out, "CSV file to write; with --surface a folder")
      ->required();
  // Ten million samples are a gigabyte of text.
  verb->add_option("--count", arguments->measurement.count, "how many samples")
      ->check(in_range(1, 10000000))
      ->capture_default_str();
  verb->add_option("--noise", arguments->measurement.noise, "sigma of log-normal noise on every value")
      ->check(in_range(0.0, 10.0))
      ->capture_default_str();
  verb->add_option("--seed", arguments->measurement.seed, "of directions and noise")
      ->check(at_least_zero())
      ->capture_default_str();
  verb->add_flag("--json", arguments->json, "print what was written as JSON");
  verb->callback([arguments] {
    if (!arguments->surface.empty())
      return measure_surface(arguments->surface, arguments->out, arguments->json);
    if (arguments->source.spec.empty()) throw CLI::RequiredError("BRDF or --surface");
    check_writable(arguments->out);
    const Source source = arguments->source.open();
    const Samples samples = [&] {
      try {
        return measure(source.ref(), arguments->measurement);
      } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", arguments->source.spec, error.what()));
      }
    }();
    write_then_rename(arguments->out, samples_csv(samples, source.findings.lambda_nm));
    if (arguments->json)
      print_as_json(
          {{"output", arguments->out}, {"samples", samples.size()}, {"channels", samples.channels}});
    else
      fmt::print("{} samples to {}\n", samples.size(), arguments->out);
  });
}

}  // namespace burnish::cli
