#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/file.h>
#include <burnish/io/convert.h>

#include "commands.h"
#include "source_arguments.h"

namespace burnish::cli {

namespace {

struct ConvertArguments {
  SourceArguments source;
  std::string out, to;
  ConvertOptions options;
};

/// The format asked for, or the one the output's name ends in.
std::string target_format(const ConvertArguments& arguments) {
  if (!arguments.to.empty()) return arguments.to;
  const std::string extension = std::filesystem::path(arguments.out).extension().string();
  if (extension == ".binary") return "merl";
  if (extension == ".bsdf") return "rgl";
  for (const char* same : {"mbsdf", "astm", "csv", "exr"})
    if (extension.substr(extension.empty() ? 0 : 1) == same) return same;
  throw CLI::ValidationError(
      arguments.out, "expected a name that ends in .binary, .bsdf, .mbsdf, .astm, .csv or .exr, or --to");
}

}  // namespace

void add_convert_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "convert",
      "Convert a BRDF to a MERL, RGL, MBSDF or Zemax table, ASTM or CSV samples, or an EXR image of slices");
  verb->footer(
      "ASTM and CSV have the samples of a scattered source, of any other samples drawn as `measure` does, or "
      "with --entries a table's entries. What is lost is said on the standard error output.\n"
      "Example: burnish convert paint.bsdf paint.binary");
  auto arguments = std::make_shared<ConvertArguments>();
  add_source_arguments(*verb, arguments->source);
  verb->add_option("OUT", arguments->out, "file to write")->required();
  verb->add_option(
          "--to", arguments->to,
          "format; by default what OUT ends in: .binary (merl), .bsdf (rgl), .mbsdf, .astm, .csv, .exr")
      ->check(CLI::IsMember(std::vector<std::string>(kConvertFormats.begin(), kConvertFormats.end())));
  verb->add_option("--cells", arguments->options.cells,
                   "along each polar angle of MERL, MBSDF and EXR, twice as many along the azimuth")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  auto* count = verb->add_option("--count", arguments->options.count,
                                 "samples in an ASTM or CSV file, unless the source is scattered")
                    ->check(CLI::Range(1, 10000000))
                    ->capture_default_str();
  verb->add_flag("--entries", arguments->options.entries, "a table's entries in an ASTM or CSV file")
      ->excludes(count);
  verb->callback([arguments] {
    const std::string format = target_format(*arguments);
    const Source source = arguments->source.open();
    const Converted converted = convert(source, format, arguments->options);
    write_then_rename(arguments->out, converted.bytes);
    if (!converted.losses.empty())
      fmt::print(stderr, "burnish: {}: lost: {}\n", arguments->out, fmt::join(converted.losses, "; "));
  });
}

}  // namespace burnish::cli
