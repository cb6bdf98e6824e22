#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/file.h>
#include <burnish/io/convert.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/surface/surface_file.h>

#include "commands.h"
#include "json_output.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct ConvertArguments {
  SourceArguments source;
  std::string out, to;
  ConvertOptions options;
  bool json = false;
};

/// The format asked for, or the one the output's name ends in.
std::string target_format(const ConvertArguments& arguments) {
  if (!arguments.to.empty()) return arguments.to;
  const std::string extension = std::filesystem::path(arguments.out).extension().string();
  if (extension == ".binary") return "merl";
  if (extension == ".bsdf") return "rgl";
  if (extension == ".xompt") return "openmaterial";
  if (extension == ".bin") return "utia";
  if (extension == ".xml") return "tensortree";
  for (const char* same : {"mbsdf", "astm", "csv", "exr", "burnish"})
    if (extension.substr(extension.empty() ? 0 : 1) == same) return same;
  throw CLI::ValidationError(arguments.out,
                             "expected a name that ends in .binary, .bin, .bsdf, .mbsdf, .xml, .xompt, "
                             ".astm, .csv, .exr or .burnish, or "
                             "--to");
}

/// A surface's other file. False where the input is none.
bool converts_surface(const ConvertArguments& arguments, const std::string& format) {
  const std::string& spec = arguments.source.spec;
  if (std::error_code none; is_analytic_spec(spec) || !std::filesystem::is_regular_file(spec, none))
    return false;
  const FileBytes file = read_file(spec);
  if (!looks_like_surface(file.bytes)) return false;
  const bool slices = format == "exr" && !arguments.to.empty();
  if (slices || (format != "exr" && format != "model" && format != "burnish"))
    throw Error::in_file(
        spec, "a surface to become .exr or .burnish, or surface:FILE#COLUMN,ROW for one of its texels",
        slices ? "slices" : format);
  const SurfaceModel surface = parse_surface(file);
  const std::string bytes = format == "burnish" ? format_surface(surface) : format_surface_exr(surface);
  write_then_rename(arguments.out, bytes);
  if (arguments.json)
    print_as_json({{"output", arguments.out},
                   {"format", format == "burnish" ? "burnish" : "model"},
                   {"bytes", bytes.size()},
                   {"lost", nlohmann::ordered_json::array()}});
  return true;
}

}  // namespace

void add_convert_command(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("convert",
                         "Convert a BRDF to another format, see `burnish help formats`; a model or a "
                         "surface to its other file");
  verb->footer(
      "ASTM and CSV have the samples of a scattered source, of any other samples drawn as `measure` does, or "
      "with --entries a table's entries. What is lost is said on the standard error output.\n"
      "Examples: burnish convert paint.bsdf paint.binary\n"
      "          burnish convert model.exr model.burnish\n"
      "          burnish convert surface:wall.burnish#3,4 texel.exr");
  auto arguments = std::make_shared<ConvertArguments>();
  add_source_arguments(*verb, arguments->source);
  auto* out = verb->add_option("OUT", arguments->out, "file to write");
  verb->add_option("-o,--output,--out", arguments->out, "the same")->excludes(out);
  verb->add_option(
          "--to", arguments->to,
          "format; by default what OUT ends in: .binary (merl), .bin (utia), .bsdf (rgl), .mbsdf, .xml "
          "(tensortree), .xompt (openmaterial), .astm, .csv, .exr (of a model or surface: model, its "
          "OpenEXR file; else slices), .burnish")
      ->check(one_of({kConvertFormats.begin(), kConvertFormats.end()}));
  verb->add_option("--cells", arguments->options.cells,
                   "along each polar angle of MERL, MBSDF and EXR, twice as many along the azimuth")
      ->check(in_range(2, 1000))
      ->capture_default_str();
  auto* count = verb->add_option("--count", arguments->options.count,
                                 "samples in an ASTM or CSV file, unless the source is scattered")
                    ->check(in_range(1, 10000000))
                    ->capture_default_str();
  verb->add_flag("--entries", arguments->options.entries, "a table's entries in an ASTM or CSV file")
      ->excludes(count);
  verb->add_flag("--notes", arguments->options.notes, "keep a model's notes of its fit in a .burnish file");
  verb->add_flag("--json", arguments->json, "print what was written and lost as JSON");
  verb->callback([arguments] {
    if (arguments->out.empty()) throw CLI::RequiredError("OUT or -o");
    std::string format = target_format(*arguments);
    check_writable(arguments->out);
    if (converts_surface(*arguments, format)) return;
    const Source source = arguments->source.open();
    // slices of a model are asked for by name
    const bool is_model = std::holds_alternative<FactoredBrdf>(source.brdf);
    if (is_model && format == "exr" && arguments->to.empty()) format = "model";
    const Converted converted = convert(source, format, arguments->options);
    write_then_rename(arguments->out, converted.bytes);
    if (arguments->json)
      print_as_json({{"output", arguments->out},
                     {"format", format},
                     {"bytes", converted.bytes.size()},
                     {"lost", converted.losses}});
    else if (!converted.losses.empty())
      fmt::print(stderr, "burnish: {}: lost: {}\n", std::filesystem::path(arguments->out).filename().string(),
                 fmt::join(converted.losses, "; "));
  });
}

}  // namespace burnish::cli
