// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/file.h>
#include <burnish/io/convert.h>
#include <burnish/io/formats.h>
#include <burnish/io/open_source.h>
#include <burnish/io/window_xml.h>
#include <burnish/math/closest_name.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/surface/surface_file.h>

#include "commands.h"
#include "counted.h"
#include "json_output.h"
#include "progress.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct ConvertArguments {
  SourceArguments source;
  std::string out, to;
  std::vector<std::string> with;  // files of further parts
  ConvertOptions options;
  bool json = false;
};

/// Lists the formats that an option applies to. Formats that keep a table's entries without it come first.
std::string formats_with(bool Format::*option, std::string_view last_by = "or") {
  std::vector<std::string_view> names;
  for (const bool entries_first : {true, false})
    for (const Format& format : formats())
      if (format.write && format.*option && format.entries_first == entries_first)
        names.push_back(format.to == "exr" ? "slices" : format.to);
  return listed(names, last_by);
}

/// Returns the format of --to, or the one that the output's name ends in.
const Format& target_format(const ConvertArguments& arguments) {
  const Format* const format =
      arguments.to.empty() ? format_ending_in(std::filesystem::path(arguments.out).extension().string())
                           : format_to(arguments.to);
  if (format) return *format;
  throw CLI::ValidationError(
      arguments.out, fmt::format("expected a name that ends in {}, or --to", listed(naming_endings())));
}

/// The options that were given. Each of them applies to some formats alone.
struct GivenOptions {
  bool cells = false, count = false, entries = false, notes = false;
};

GivenOptions given_options(const CLI::App& verb) {
  const auto given = [&](const char* name) { return verb.get_option(name)->count() > 0; };
  return {given("--cells"), given("--count"), given("--entries"), given("--notes")};
}

/// Refuses options that do not apply to the format.
void check_options(const GivenOptions& given, const Format& format) {
  const auto refuse = [&](bool wanted, const char* option, const std::string& formats) {
    if (wanted)
      throw CLI::ValidationError(
          fmt::format("{}: expected {} to be written with it, found {}", option, formats, format.to));
  };
  refuse(given.cells && !format.takes_cells, "--cells", formats_with(&Format::takes_cells));
  refuse(given.count && !format.takes_count, "--count", formats_with(&Format::takes_count));
  refuse(given.entries && !format.takes_count, "--entries", formats_with(&Format::takes_count));
  refuse(given.notes && !format.takes_notes, "--notes", "a .burnish file");
}

/// Refuses options that do not apply to the source.
void check_source(const GivenOptions& given, const Source& source) {
  if (given.count && source.samples())
    throw CLI::ValidationError(
        fmt::format("--count: expected a source to draw from, found {}, which are all written",
                    counted(source.samples()->size(), "sample")));
}

/// Prints losses, notes on changed meaning, and warnings on standard error, a line each.
void print_said(const std::string& out, const Converted& converted) {
  const std::string name = std::filesystem::path(out).filename().string();
  if (!converted.losses.empty())
    fmt::print(stderr, "burnish: {}: lost: {}\n", name, fmt::join(converted.losses, "; "));
  for (const std::string& note : converted.notes) fmt::print(stderr, "burnish: {}: {}\n", name, note);
  for (const std::string& warning : converted.warnings)
    fmt::print(stderr, "burnish: {}: warning: {}\n", name, warning);
}

/// Writes a surface in its other format. Returns false where the input is no surface.
bool converts_surface(const ConvertArguments& arguments, std::string_view format) {
  const std::string& spec = arguments.source.spec;
  if (std::error_code none; is_analytic_spec(spec) || !std::filesystem::is_regular_file(spec, none))
    return false;
  const FileBytes file = read_file(spec);
  if (!looks_like_surface(file.bytes)) return false;
  const bool slices = format == "exr" && !arguments.to.empty();
  if (slices || (format != "exr" && format != "model" && format != "burnish"))
    throw Error::in_file(
        spec, "a surface to become .exr or .burnish, or surface:FILE#COLUMN,ROW for one of its texels",
        slices ? "slices" : std::string(format));
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

/// Returns the source and, for a format that holds several parts, the other parts: those of its file, unless one was
/// asked for, and those of the files of --with.
std::vector<Source> with_other_parts(const ConvertArguments& arguments, const Format& format, Source source) {
  std::vector<Source> parts;
  parts.push_back(std::move(source));
  const Findings found = parts.front().findings;
  const OpenOptions& given = arguments.source.options;
  if (format.write_parts && !given.part && given.band.empty() && found.block)
    for (const BsdfBlock& block : found.blocks) {
      // CIE-XYZ stands for bands that are listed themselves.
      if (block == found.block || block.band == kColourBand) continue;
      OpenOptions options = given;
      options.part = block.part;
      options.band = block.band;
      parts.push_back(open_source(arguments.source.spec, options));
    }
  for (const std::string& file : arguments.with) {
    SourceArguments other = arguments.source;
    other.spec = file;
    parts.push_back(other.open());
  }
  return parts;
}

void run_convert(const ConvertArguments& given_arguments, const GivenOptions& given) {
  ConvertArguments arguments = given_arguments;
  if (arguments.out.empty()) throw CLI::RequiredError("OUT or -o");
  const Format* format = &target_format(arguments);
  check_ending(arguments.out, endings_of(*format));
  check_options(given, *format);
  check_writable(arguments.out);
  if (converts_surface(arguments, format->to)) return;
  Source source = arguments.source.open();
  check_source(given, source);
  // Patches stay patches unless --to names the other format of this ending.
  if (std::holds_alternative<PatchTable>(source.brdf) && format->to == "tensortree" && arguments.to.empty())
    format = format_to("klems");
  // A model is written as slices only if --to names them.
  const bool is_model = std::holds_alternative<FactoredBrdf>(source.brdf);
  if (is_model && format->to == "exr" && arguments.to.empty()) format = format_to("model");
  check_options(given, *format);
  // Entries of a measured table are kept, unless --count asks for draws.
  if (!given.count && format->entries_first && has_entries(source)) arguments.options.entries = true;
  const std::vector<Source> parts = with_other_parts(arguments, *format, std::move(source));
  const Converted converted = [&] {
    const Progress progress("converting");
    return convert_parts(parts, format->to, arguments.options);
  }();
  if (given.cells && !converted.resampled)
    throw CLI::ValidationError(fmt::format(
        "--cells: expected a source that is sampled anew, found entries that {} keeps as they are",
        format->to));
  write_then_rename(arguments.out, converted.bytes);
  if (!arguments.json) return print_said(arguments.out, converted);
  print_as_json({{"output", arguments.out},
                 {"format", format->to},
                 {"bytes", converted.bytes.size()},
                 {"lost", converted.losses},
                 {"notes", converted.notes},
                 {"warnings", converted.warnings}});
}

}  // namespace

void add_convert_command(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("convert",
                         "Convert a BRDF to another format, see `burnish help formats`; a model or a "
                         "surface to its other file");
  verb->footer(
      "ASTM and CSV have the samples of a scattered source, the entries of a table, and drawn samples of any "
      "other BRDF. Losses are listed on the standard error output.\n"
      "Examples: burnish convert paint.bsdf paint.binary\n"
      "          burnish convert paint.binary paint.csv\n"
      "          burnish convert model.exr model.burnish\n"
      "          burnish convert front.burnish shade.xml --to klems --with back.burnish\n"
      "          burnish convert surface:wall.burnish#3,4 texel.exr");
  auto arguments = std::make_shared<ConvertArguments>();
  add_source_arguments(*verb, arguments->source);
  auto* out = verb->add_option("OUT", arguments->out, "Names the file to write.");
  verb->add_option("-o,--output,--out", arguments->out, "Names the file to write, as OUT does.")
      ->excludes(out);
  const std::vector<std::string_view> names = convert_formats();
  verb->add_option("--to", arguments->to,
                   "Writes this format, not the one that OUT's ending names; exr of a model writes slices.")
      ->check(one_of({names.begin(), names.end()}));
  verb->add_option("--cells", arguments->options.cells,
                   fmt::format("Makes this many cells along each polar angle of {}, twice as many along the "
                               "azimuth.",
                               formats_with(&Format::takes_cells, "and")))
      ->check(in_range(2, 1000))
      ->capture_default_str();
  verb->add_option("--with", arguments->with,
                   "Adds the parts of further files to one that holds several: klems, tensortree, speos.")
      ->type_name("FILE");
  auto* count = verb->add_option("--count", arguments->options.count,
                                 fmt::format("Draws this many samples for {}, instead of a table's entries.",
                                             formats_with(&Format::takes_count)))
                    ->check(in_range(1, 10000000))
                    ->capture_default_str();
  verb->add_flag("--entries", arguments->options.entries,
                 "Writes a table's entries to openmaterial too; astm and csv get them without this option.")
      ->excludes(count);
  verb->add_flag("--notes", arguments->options.notes, "Keeps a model's notes of its fit in a .burnish file.");
  verb->add_flag("--json", arguments->json, "Prints what was written and lost as JSON.");
  verb->callback([arguments, verb] { run_convert(*arguments, given_options(*verb)); });
}

}  // namespace burnish::cli
