#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include <burnish/file.h>
#include <burnish/io/csv.h>
#include <burnish/io/merl.h>
#include <burnish/io/rgl.h>
#include <burnish/io/slice_image.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/rgl_builder.h>

#include "commands.h"
#include "source_arguments.h"

namespace burnish::cli {

namespace {

struct Arguments {
  SourceArguments source;
  std::string out, to;
  MeasureOptions measurement{100000, 0, 1};
};

/// The format asked for, or the one the output's name ends in.
std::string target_format(const Arguments& arguments) {
  if (!arguments.to.empty()) return arguments.to;
  const std::string extension = std::filesystem::path(arguments.out).extension().string();
  if (extension == ".binary") return "merl";
  if (extension == ".bsdf") return "rgl";
  if (extension == ".csv" || extension == ".exr") return extension.substr(1);
  throw CLI::ValidationError(arguments.out,
                             "expected a name that ends in .binary, .bsdf, .csv or .exr, or --to");
}

/// A table keeps its entries; anything else is tabulated as MERL does.
std::string slices(const Source& source) {
  if (const auto* table = std::get_if<HalfDiffTable>(&source.brdf)) return format_slice_image(*table);
  return format_slice_image(tabulate_half_diff(source.ref(), 90, 90, 180, false));
}

}  // namespace

void add_convert_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "convert", "Convert a BRDF to a MERL or RGL table, CSV samples or an EXR image of slices");
  verb->footer(
      "CSV has the samples of a scattered source, and samples drawn as `measure` does of any other.\n"
      "Example: burnish convert paint.bsdf paint.binary");
  auto arguments = std::make_shared<Arguments>();
  add_source_arguments(*verb, arguments->source);
  verb->add_option("OUT", arguments->out, "file to write")->required();
  verb->add_option("--to", arguments->to, "format; by default what OUT ends in: .binary, .bsdf, .csv, .exr")
      ->check(CLI::IsMember({"merl", "rgl", "csv", "exr"}));
  verb->add_option("--count", arguments->measurement.count,
                   "samples in a CSV file, unless the source is scattered")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str();
  verb->callback([arguments] {
    const std::string format = target_format(*arguments);
    const Source source = arguments->source.open();
    if (format == "merl") {
      write_merl(arguments->out, source.ref());
    } else if (format == "rgl") {
      RglOptions options;
      options.lambda_nm = source.findings.lambda_nm;
      options.description = source.name;
      write_then_rename(arguments->out, format_rgl(make_rgl_table(source.ref(), options)));
    } else if (format == "exr") {
      write_then_rename(arguments->out, slices(source));
    } else {
      const Samples* samples = source.samples();
      write_then_rename(arguments->out,
                        samples_csv(samples ? *samples : measure(source.ref(), arguments->measurement),
                                    source.findings.lambda_nm));
    }
  });
}

}  // namespace burnish::cli
