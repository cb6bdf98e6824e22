// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/export/export_openpbr.h>
#include <burnish/export/gltf_binary.h>
#include <burnish/export/html_page.h>
#include <burnish/export/manifest.h>
#include <burnish/export/materialx.h>
#include <burnish/export/mdl.h>
#include <burnish/export/nearest_material.h>
#include <burnish/export/sampler_files.h>
#include <burnish/export/usda.h>
#include <burnish/export/web_module.h>
#include <burnish/fitting/parametric/gltf_json.h>
#include <burnish/fitting/parametric/metallic_roughness_fit.h>
#include <burnish/io/convert.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/shaders/openpbr_shader.h>

namespace burnish {

namespace {

using nlohmann::json;

const OpenPbr& material_of(const AnalyticBrdf& brdf) {
  const auto* const model = std::get_if<OpenPbr>(&brdf.variant());
  if (!model) throw Error(fmt::format("export: expected openpbr, found {}", brdf.model().name));
  return *model;
}

// The files of one target that is no shader, and what the manifest says of it besides their names.
struct TargetFiles {
  std::vector<ExportedFile> files;
  json entry = json::object();
  std::string lossy = {};  // the file that says less
  std::vector<std::string> losses = {};
};

TargetFiles gltf_file(const NearestGltf& nearest, const std::string& name) {
  return {.files = {{name + ".glb", gltf_binary(gltf_json(nearest.material), name)}},
          .entry = {{"material", gltf_entry(nearest)}}};
}

TargetFiles files_of(const AnalyticBrdf& brdf, ExportTarget target, const ExportOptions& options) {
  const OpenPbr& material = material_of(brdf);
  const OpenPbrParameters& parameters = material.parameters();
  const std::string& name = options.name;
  switch (target) {
    case ExportTarget::materialx:
      return {.files = {materialx_file(parameters, name)}};
    case ExportTarget::usda:
      return {
          .files = {{name + ".usda", usda_layer(parameters, fit_metallic_roughness(brdf).material, name)}}};
    case ExportTarget::gltf:
      return gltf_file(nearest_gltf(brdf), name);
    case ExportTarget::mdl: {
      MdlModule module = mdl_module({.name = name, .brdf = brdf, .findings = {}}, options.cells, name);
      return {.files = std::move(module.files),
              .entry = {{"losses", module.losses}},
              .lossy = name + ".mbsdf",
              .losses = module.losses};
    }
    case ExportTarget::rgl: {
      Converted table = convert({.name = name, .brdf = brdf, .findings = {}}, "rgl", {});
      return {.files = {{name + ".bsdf", std::move(table.bytes)}},
              .lossy = name + ".bsdf",
              .losses = std::move(table.losses)};
    }
    case ExportTarget::three:
      return {.files = {
                  {name + ".three.js", three_module(material, fit_metallic_roughness(brdf).material, name)}}};
    case ExportTarget::babylon:
      return {.files = {{name + ".babylon.js", babylon_module(material, name)}}};
    case ExportTarget::html:
      return {.files = {{name + ".html", html_page(material, name)}}};
    default:
      throw Error(fmt::format(
          "export: expected a target other than ktx2, cube, exr and png for openpbr, which has no "
          "tables, found {}; `burnish fit` makes a model of it for that",
          to_string(target)));
  }
}

}  // namespace

ExportedFiles export_openpbr(const AnalyticBrdf& brdf, const ExportOptions& options) {
  json manifest{
      {"generator", "burnish"}, {"name", options.name}, {"model", format_analytic(brdf)}, {"channels", 3}};
  ExportedFiles result;
  for (const ExportTarget target : options.to) {
    if (const std::optional<ShaderLanguage> language = language_of(target)) {
      const Shader shader = generate_shader(material_of(brdf), *language, options.name);
      const std::string file = shader_file(*language, options.name);
      result.files.push_back({file, shader.text});
      result.shaders.push_back({file, "formulas", shader.cost});
      manifest["shaders"].push_back(manifest_entry(*language, options.name, shader));
      continue;
    }
    TargetFiles made = files_of(brdf, target, options);
    result.lose(made.lossy, made.losses);
    json& entry = manifest[std::string(to_string(target))];
    entry.update(made.entry);
    for (ExportedFile& file : made.files) {
      entry["files"].push_back(file.name);
      result.files.push_back(std::move(file));
    }
  }
  if (options.sample) add_sampler(brdf.ref(), options, result, manifest);
  result.files.push_back(manifest_file(manifest, options.name));
  return result;
}

}  // namespace burnish
