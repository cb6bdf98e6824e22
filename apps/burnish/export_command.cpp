#include <algorithm>
#include <bit>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/model_file.h>
#include <burnish/file.h>
#include <burnish/io/rgl.h>
#include <burnish/power/choose.h>
#include <burnish/reflectance/rgl_builder.h>
#include <burnish/shaders/specular_shader.h>
#include <burnish/textures/image_files.h>
#include <burnish/textures/ktx2.h>

#include "commands.h"
#include "environment_argument.h"
#include "export_files.h"
#include "export_formats.h"
#include "export_page.h"
#include "usage.h"

namespace burnish::cli {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// What shaders can be called, of a file's name.
std::string name_of(const std::string& path) {
  std::string name;
  for (const char c : fs::path(path).stem().string()) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'), digit = c >= '0' && c <= '9';
    if (letter || (digit && !name.empty()))
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (name.ends_with('_')) name.pop_back();
  return name.empty() ? "brdf" : name;
}

json cost_of(const ShaderCost& cost) {
  return {{"fetches", cost.fetches},
          {"operations", cost.operations},
          {"divisions", cost.divisions},
          {"roots", cost.roots},
          {"powers", cost.powers}};
}

json shader_entry(const ExportTarget& target, const std::string& file, const std::string& name,
                  const Shader& shader) {
  return {{"language", target.name},
          {"file", file},
          {"functions", {"burnish_" + name, "burnish_" + name + "_world"}},
          {"cost", cost_of(shader.cost)}};
}

// The files of an export but its manifest, which they are described in.
std::vector<ExportedFile> export_files(const FactoredBrdf& brdf, const ExportArguments& arguments,
                                       json& manifest) {
  const std::string& name = arguments.name;
  const auto wants = [&](const char* target) {
    return std::ranges::find(arguments.to, target) != arguments.to.end();
  };
  std::vector<ExportedFile> files;
  bool textures = wants("ktx2");
  for (const ExportTarget& target : kExportTargets) {
    if (!wants(target.name)) continue;
    const bool cpp = target.language == ShaderLanguage::cpp;
    const ShaderFilter filter = arguments.exact || cpp ? ShaderFilter::exact : ShaderFilter::hardware;
    const Shader shader = generate_shader(brdf, {target.language, filter, name});
    files.push_back({fmt::format("{}.{}", name, target.extension), shader.text});
    manifest["shaders"].push_back(shader_entry(target, files.back().name, name, shader));
    manifest["shaders"].back()["filter"] = filter == ShaderFilter::exact ? "exact" : "hardware";
    for (const ShaderTexture& texture : shader.textures)
      if (!cpp) manifest["shaders"].back()["textures"].push_back(texture.name);
    textures = textures || !cpp;
  }
  if (textures) add_textures(brdf, arguments, files, manifest);
  for (std::size_t i = 0; wants("cube") && i < brdf.tables().size(); ++i) {
    const Table& table = brdf.tables()[i];
    if (table.layout.shape == TableShape::grid) continue;  // of two directions
    // twice as fine at the normal as a disk without a warp
    const Texture cube = make_cube_map(
        table, static_cast<int>(std::bit_ceil(static_cast<unsigned>(table.layout.width))), arguments.mips);
    files.push_back({fmt::format("{}_{}.cube.ktx2", name, i), encode_ktx2(cube, !arguments.plain)});
    manifest["cube_maps"].push_back({{"table", table.name},
                                     {"file", files.back().name},
                                     {"side", cube.width},
                                     {"levels", cube.levels.size()},
                                     {"format", to_string(table.format)}});
  }
  const std::pair<const char*, std::string (*)(const Table&)> images[] = {{"exr", encode_exr},
                                                                          {"png", encode_png_table}};
  for (const auto& [extension, encode] : images)
    for (std::size_t i = 0; wants(extension) && i < brdf.tables().size(); ++i) {
      files.push_back({fmt::format("{}_{}.{}", name, i, extension), encode(brdf.tables()[i])});
      manifest["images"].push_back({{"table", brdf.tables()[i].name}, {"file", files.back().name}});
    }
  if (wants("gltf")) {
    files.push_back({name + ".glb", export_gltf(brdf, name, manifest)});
    manifest["gltf"] = files.back().name;
  }
  if (wants("three")) {
    files.push_back({name + ".three.js", export_three(brdf, name)});
    manifest["three"] = files.back().name;
  }
  if (wants("rgl")) {
    files.push_back({name + ".bsdf", format_rgl(make_rgl_table(brdf, {.description = name}))});
    manifest["rgl"] = files.back().name;
  }
  std::optional<SurfaceLight> light;
  if (const auto environment = environment_of(arguments.environment)) {
    light.emplace(brdf, *environment);
    add_light(*light, arguments, files, manifest);
  }
  if (wants("html")) {
    files.push_back({name + ".html", export_page(brdf, name, light ? &*light : nullptr)});
    manifest["page"] = files.back().name;
  }
  return files;
}

// Blinn's or Phong's model with a member of the specular family, by default the cheapest within one of 255
// levels.
SpecularModel specular_of(const AnalyticBrdf& brdf, const std::string& power) {
  std::optional<SpecularModel> model = specular_model(brdf, PowerMethod::exact);
  if (!model)
    throw Error(
        fmt::format("export: expected a factored BRDF (see burnish fit), or phong, blinn_phong or their "
                    "normalized forms, found {}",
                    brdf.model().name));
  constexpr double kMostError = 1.0 / 255;
  model->method = power.empty() ? choose_power(kMostError, model->exponent, model->exponent).front().method
                                : usage([&] { return power_method(power); });
  return *model;
}

std::vector<ExportedFile> export_files(const SpecularModel& model, const ExportArguments& arguments,
                                       json& manifest) {
  std::vector<ExportedFile> files;
  for (const std::string& to : arguments.to) {
    if (to == "html") {
      files.push_back({arguments.name + ".html", export_page(model, arguments.model, arguments.name)});
      manifest["page"] = files.back().name;
      continue;
    }
    const auto target = std::ranges::find(kExportTargets, to, &ExportTarget::name);
    if (target == std::end(kExportTargets))
      throw Error(
          fmt::format("export: expected a shader language or html for {}, found {}", arguments.model, to));
    const Shader shader = generate_shader(model, target->language, arguments.name);
    files.push_back({fmt::format("{}.{}", arguments.name, target->extension), shader.text});
    manifest["shaders"].push_back(shader_entry(*target, files.back().name, arguments.name, shader));
  }
  return files;
}

}  // namespace

void add_export_command(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("export",
                         "Write a factored BRDF as shaders, textures, glTF, a three.js module, "
                         "an RGL table, or a page that shows it; or Phong's and Blinn's models as shaders");
  verb->footer(
      "Every shader comes with its textures but C++, which has them inside; NAME.json says what is in the "
      "folder and what an evaluation costs. See docs/guide/shaders.md.\n"
      "Examples: burnish export paint.exr --to glsl --to html -o paint\n"
      "          burnish export paint.exr --to glsl_es --to html --environment studio -o paint\n"
      "          burnish export blinn_phong:exponent=60,ks=0.8 --to wgsl --power cubic2 -o highlight");
  auto arguments = std::make_shared<ExportArguments>();
  verb->add_option("MODEL", arguments->model,
                   "factored BRDF, as `burnish fit` writes it, or one such as blinn_phong:exponent=60")
      ->required();
  std::vector<std::string> targets{"ktx2", "cube", "exr", "png", "gltf", "three", "rgl", "html"};
  for (const ExportTarget& target : kExportTargets) targets.emplace_back(target.name);
  verb->add_option("--to", arguments->to, "what to write; may be given several times")
      ->required()
      ->check(CLI::IsMember(targets));
  verb->add_option("-o,--out", arguments->folder, "folder, made where it is missing")->required();
  verb->add_option("--name", arguments->name, "of functions and files; by default from MODEL's name");
  verb->add_option(
      "--power", arguments->power,
      "of phong and blinn_phong: how the power is computed, see `burnish specular list`; by default the "
      "cheapest that is never one of 255 levels off");
  add_environment_argument(*verb, arguments->environment);
  verb->add_flag("--exact", arguments->exact, "shaders that weigh texels themselves, in floats");
  verb->add_flag("--mips", arguments->mips, "KTX2 with levels: averages over the directions of a texel");
  verb->add_flag("--plain", arguments->plain, "textures that are not compressed");
  verb->callback([arguments] {
    json manifest{{"generator", "burnish"}};
    std::vector<ExportedFile> files;
    if (is_analytic_spec(arguments->model)) {
      const AnalyticBrdf brdf = parse_analytic(arguments->model);
      if (!arguments->environment.empty())
        throw CLI::ValidationError("--environment: expected a factored BRDF with it, found " +
                                   arguments->model);
      if (arguments->name.empty()) arguments->name = brdf.model().name;
      const SpecularModel model = specular_of(brdf, arguments->power);
      manifest.update({{"name", arguments->name},
                       {"model", format_analytic(brdf)},
                       {"channels", 3},
                       {"power",
                        {{"method", power_info(model.method).name},
                         {"formula", power_info(model.method).formula},
                         {"bound", power_bound(model.method, model.exponent)}}}});
      files = export_files(model, *arguments, manifest);
    } else {
      if (!arguments->power.empty())
        throw CLI::ValidationError("--power: expected phong or blinn_phong with it, found a file");
      const auto lit = [](const std::string& to) { return to == "glsl" || to == "glsl_es" || to == "html"; };
      if (!arguments->environment.empty() && std::ranges::none_of(arguments->to, lit))
        throw CLI::ValidationError(
            "--environment: expected --to glsl, glsl_es or html with it, found others");
      if (arguments->name.empty()) arguments->name = name_of(arguments->model);
      const FactoredBrdf brdf = parse_model(read_file(arguments->model)).brdf;
      manifest.update({{"name", arguments->name},
                       {"model", model_expression(brdf)},
                       {"channels", brdf.channels()},
                       {"table_bytes", brdf.table_bytes()}});
      files = export_files(brdf, *arguments, manifest);
    }
    files.push_back(
        {arguments->name + ".json", manifest.dump(2, ' ', true, json::error_handler_t::replace) + "\n"});
    std::error_code failed;
    fs::create_directories(arguments->folder, failed);
    if (failed) throw Error::in_file(arguments->folder, "a folder", failed.message());
    for (const ExportedFile& file : files) {
      write_then_rename(fs::path(arguments->folder) / file.name, file.bytes);
      fmt::print("{}\n", file.name);
    }
    if (!manifest.contains("shaders")) return;
    for (const json& shader : manifest["shaders"]) {
      const json& c = shader["cost"];
      const std::string how = manifest.contains("power") ? manifest["power"]["method"].get<std::string>()
                                                         : shader["filter"].get<std::string>() + " filter";
      fmt::print(
          "{}: {}, {}\n", shader["file"].get<std::string>(), how,
          to_string(ShaderCost{c["fetches"], c["operations"], c["divisions"], c["roots"], c["powers"]}));
    }
  });
}

}  // namespace burnish::cli
