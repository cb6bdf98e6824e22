// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/export/export_model.h>
#include <burnish/export/export_openpbr.h>
#include <burnish/export/export_specular.h>
#include <burnish/export/export_surface.h>
#include <burnish/io/open_source.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/source.h>
#include <burnish/surface/surface_file.h>

#include "commands.h"
#include "environment_argument.h"
#include "json_output.h"
#include "progress.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct ExportArguments {
  std::string model, folder, name, power, environment;
  std::vector<std::string> to;
  int cells = ExportOptions{}.cells;
  std::optional<int> binding, set, space;
  bool appended = false, exact = false, half = false, plain = false, blocks = false, mips = false,
       area = false, sample = false, json = false;
};

std::string name_of(const std::string& path) {
  return export_name(std::filesystem::path(path).stem().string());
}

ExportOptions options_of(const ExportArguments& arguments) {
  ExportOptions options{.to = {},
                        .name = arguments.name,
                        .exact = arguments.exact,
                        .half = arguments.half,
                        .mips = arguments.mips,
                        .compressed = !arguments.plain,
                        .blocks = arguments.blocks,
                        .area = arguments.area,
                        .sample = arguments.sample,
                        .cells = arguments.cells,
                        .places = {arguments.binding, arguments.set, arguments.space},
                        .appended = arguments.appended};
  for (const std::string& to : arguments.to) options.to.push_back(export_target(to));
  return options;
}

ExportedFiles exported_analytic(const ExportArguments& arguments, const AnalyticBrdf& brdf) {
  const std::string_view model = brdf.model().name;
  if (!arguments.environment.empty())
    throw CLI::ValidationError("--environment: expected a factored BRDF with it, found " + arguments.model);
  if (arguments.half)
    throw CLI::ValidationError("--half: expected a factored BRDF with it, found " + arguments.model);
  ExportOptions options = options_of(arguments);
  if (options.name.empty())
    options.name = is_analytic_spec(arguments.model) ? std::string(model) : name_of(arguments.model);
  if (arguments.area)
    throw CLI::ValidationError("--area: expected a factored BRDF with it, found " + arguments.model);
  std::optional<PowerMethod> power;
  if (!arguments.power.empty()) power = usage([&] { return power_method(arguments.power); });
  if (model != "openpbr") return export_specular(format_analytic(brdf), power, options);
  if (power) throw CLI::ValidationError("--power: expected phong or blinn_phong with it, found openpbr");
  return export_openpbr(brdf, options);
}

ExportedFiles exported_model(const ExportArguments& arguments, const Source& source) {
  if (!arguments.power.empty())
    throw CLI::ValidationError("--power: expected phong or blinn_phong with it, found a file");
  ExportOptions options = options_of(arguments);
  if (!arguments.environment.empty() && std::ranges::none_of(options.to, shows_environment))
    throw CLI::ValidationError(fmt::format("--environment: expected --to {} with it, found {}",
                                           targets_that(shows_environment), names_of(options.to)));
  if (options.half && std::ranges::none_of(options.to, has_half_products))
    throw CLI::ValidationError(fmt::format("--half: expected --to {} with it, found {}",
                                           targets_that(has_half_products), names_of(options.to)));
  if (options.area && std::ranges::none_of(options.to, has_half_products))
    throw CLI::ValidationError(fmt::format("--area: expected --to {} with it, found {}",
                                           targets_that(has_half_products), names_of(options.to)));
  if (options.name.empty()) options.name = name_of(arguments.model);
  Model model = to_model(source);
  const FactoredBrdf& brdf = model.brdf;
  options.notes = std::move(model.notes);
  if (source.findings.transmits())
    fmt::print(
        stderr,
        "burnish: {}: warning: The model is a transmission: exports take wo mirrored through the surface.\n",
        arguments.model);
  options.environment = environment_of(arguments.environment);
  return export_model(brdf, options);
}

ExportedFiles exported_surface(const ExportArguments& arguments, const FileBytes& file) {
  if (!arguments.power.empty() || !arguments.environment.empty() || arguments.half)
    throw CLI::ValidationError("--power, --environment, --half: expected a model with them, found a surface");
  if (arguments.area) throw CLI::ValidationError("--area: expected a model with it, found a surface");
  if (arguments.sample) throw CLI::ValidationError("--sample: expected a model with it, found a surface");
  ExportOptions options = options_of(arguments);
  if (arguments.blocks && std::ranges::none_of(options.to, has_map_textures))
    throw CLI::ValidationError("--blocks: expected --to ktx2 or a shader language with it, found " +
                               names_of(options.to));
  if (options.name.empty()) options.name = name_of(arguments.model);
  return export_surface(parse_surface(file).brdf, options);
}

ExportedFiles exported_files(const ExportArguments& arguments) {
  if (std::error_code none; std::filesystem::is_regular_file(arguments.model, none)) {
    const FileBytes file = read_file(arguments.model);
    if (looks_like_surface(file.bytes)) return exported_surface(arguments, file);
  }
  if (arguments.blocks)
    throw CLI::ValidationError("--blocks: expected a surface with it, found " + arguments.model);
  const Source source = open_source(arguments.model, {});
  const auto* const analytic = std::get_if<AnalyticBrdf>(&source.brdf);
  return analytic ? exported_analytic(arguments, *analytic) : exported_model(arguments, source);
}

// Checks each number: it needs a target that takes it, and some need textures with places.
void check_numbers(const ExportArguments& arguments) {
  const ExportOptions options = options_of(arguments);
  const auto check = [&](const char* option, const std::optional<int>& number,
                         bool (*has)(ExportTarget target) noexcept) {
    if (!number) return;
    if (std::ranges::none_of(options.to, has))
      throw CLI::ValidationError(fmt::format("{}: expected --to {} with it, found {}", option,
                                             targets_that(has), names_of(options.to)));
    if (!arguments.environment.empty())
      throw CLI::ValidationError(
          fmt::format("{}: expected no --environment with it, found {}", option, arguments.environment));
  };
  check("--binding", arguments.binding, has_bindings);
  check("--set", arguments.set, has_sets);
  check("--space", arguments.space, has_spaces);
  if (arguments.sample && std::ranges::none_of(options.to, is_language))
    throw CLI::ValidationError("--sample: expected a shader language with it, found " + names_of(options.to));
}

void run(const ExportArguments& arguments) {
  check_numbers(arguments);
  check_folder_name(arguments.folder);
  check_folder(arguments.folder);
  const ExportedFiles exported = [&] {
    const Progress progress("exporting");
    return exported_files(arguments);
  }();
  write_files(arguments.folder, exported.files);
  if (arguments.json) {
    auto files = nlohmann::ordered_json::array();
    for (const ExportedFile& file : exported.files) files.push_back(file.name);
    auto shaders = nlohmann::ordered_json::array();
    for (const auto& [file, how, cost] : exported.shaders)
      shaders.push_back({{"file", file}, {"how", how}, {"cost", to_string(cost)}});
    print_as_json(
        {{"output", arguments.folder}, {"files", files}, {"shaders", shaders}, {"lost", exported.losses}});
    return;
  }
  for (const ExportedFile& file : exported.files) fmt::print("{}\n", file.name);
  for (const auto& [file, how, cost] : exported.shaders)
    fmt::print("{}: {}, {}\n", file, how, to_string(cost));
  for (const std::string& loss : exported.losses) fmt::print(stderr, "burnish: lost: {}\n", loss);
}

}  // namespace

void add_export_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("export",
                                      "Write a model or a surface as shaders, textures, MaterialX, USD, MDL, "
                                      "glTF, for three.js or Babylon.js, or as a "
                                      "page");
  verb->footer(
      "A surface becomes shaders, textures, modules of three.js and pages. OpenPBR becomes all but textures, "
      "Phong's and Blinn's models become shaders. Every shader comes with its textures, but C++ has them "
      "inside. NAME.json lists the files and the cost of an evaluation. See docs/guide/shaders.md and "
      "docs/guide/export.md.\n"
      "Examples: burnish export paint.exr --to glsl,html -o paint\n"
      "          burnish export paint.exr --to glsl_es --to html --environment studio -o paint\n"
      "          burnish export paint.exr --to glsl_es --to wgsl --half -o paint\n"
      "          burnish export paint.exr --to materialx --to usda -o paint\n"
      "          burnish export wall.burnish --to glsl --to hlsl -o wall\n"
      "          burnish export openpbr:coat_weight=1 --to materialx --to three --to glsl -o coated\n"
      "          burnish export blinn_phong:exponent=60,ks=0.8 --to wgsl --power cubic2 -o highlight");
  auto arguments = std::make_shared<ExportArguments>();
  verb->add_option("MODEL", arguments->model,
                   "Names a factored BRDF, surface or OpenPBR as `burnish fit` writes them, or an analytic "
                   "one such as blinn_phong:exponent=60.")
      ->required();
  const auto names = export_target_names();
  verb->add_option("--to", arguments->to, "Writes these, separated by commas.")
      ->required()
      ->delimiter(',')
      ->check(one_of({names.begin(), names.end()}));
  verb->add_option("-o,--output,--out", arguments->folder,
                   "Names the folder to write to, which is made where it is missing.")
      ->required();
  verb->add_option("--name", arguments->name, "Names functions and files (default: as MODEL is named).");
  verb->add_option("--power", arguments->power,
                   "Computes the power of phong and blinn_phong by this method of `burnish specular list` "
                   "(default: the cheapest within one of 255 levels).");
  add_environment_argument(*verb, arguments->environment);
  CLI::Option* const cells =
      verb->add_option("--cells", arguments->cells,
                       "Makes this many cells along each polar angle of an mdl measurement.")
          ->check(in_range(2, 1000))
          ->capture_default_str();
  CLI::Option* const exact =
      verb->add_flag("--exact", arguments->exact,
                     "Writes shaders that interpolate texels in floats, not by the texture unit.");
  verb->add_flag("--half", arguments->half,
                 "Writes shaders that multiply texels in half precision, within 1 %; cpp stays single.")
      ->excludes(exact);
  verb->add_flag("--area", arguments->area,
                 "Writes functions of area lights too, NAME.area.*, with their own texture; cpp has none.");
  verb->add_flag(
      "--sample", arguments->sample,
      "Writes functions that draw directions too, NAME.sample.*, with their own texture; cpp has it "
      "inside.");
  constexpr int kMostBindings = 1 << 20;
  verb->add_option(
          "--binding", arguments->binding,
          "Numbers bindings of glsl, slang and wgsl, and registers of hlsl, from this one (default: 0).")
      ->check(in_range(0, kMostBindings));
  verb->add_option("--set", arguments->set,
                   "Puts textures into this descriptor set of glsl, for Vulkan, and slang, or group of wgsl.")
      ->check(in_range(0, kMostBindings));
  verb->add_option("--space", arguments->space, "Puts textures into this register space of hlsl.")
      ->check(in_range(0, kMostBindings));
  verb->add_flag("--appended", arguments->appended,
                 "Writes shaders that are appended to others in one file: without `enable f16` of wgsl.");
  verb->add_flag("--mips", arguments->mips,
                 "Writes KTX2 with mip levels, which average over the directions of a texel.");
  verb->add_flag("--plain", arguments->plain, "Writes KTX2 without Zstandard.");
  verb->add_flag("--blocks", arguments->blocks,
                 "Writes a surface's maps as pairs in BC5, which stay compressed where they are read, and "
                 "shaders for them.");
  verb->add_flag("--json", arguments->json, "Prints the files and what shaders cost as JSON.");
  verb->callback([arguments, cells] {
    if (cells->count() > 0 && std::ranges::find(arguments->to, "mdl") == arguments->to.end())
      throw CLI::ValidationError(
          fmt::format("--cells: expected --to mdl with it, found {}", fmt::join(arguments->to, ", ")));
    run(*arguments);
  });
}

}  // namespace burnish::cli
