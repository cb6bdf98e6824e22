#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/export/export_openpbr.h>
#include <burnish/export/gltf_binary.h>
#include <burnish/export/manifest.h>
#include <burnish/export/materialx.h>
#include <burnish/export/mdl.h>
#include <burnish/export/usda.h>
#include <burnish/fitting/parametric/metallic_roughness_fit.h>
#include <burnish/io/rgl.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/rgl_builder.h>

namespace burnish {

namespace {

using nlohmann::json;

const OpenPbrParameters& parameters_of(const AnalyticBrdf& brdf) {
  const auto* const model = std::get_if<OpenPbr>(&brdf.variant());
  if (!model) throw Error(fmt::format("export: expected openpbr, found {}", brdf.model().name));
  return model->parameters();
}

// The files of one target, without the manifest.
std::vector<ExportedFile> files_of(const AnalyticBrdf& brdf, ExportTarget target,
                                   const ExportOptions& options, json& manifest) {
  const OpenPbrParameters& parameters = parameters_of(brdf);
  const std::string& name = options.name;
  switch (target) {
    case ExportTarget::materialx:
      return {materialx_file(parameters, name)};
    case ExportTarget::usda:
      return {{name + ".usda", usda_layer(parameters, fit_metallic_roughness(brdf).material, name)}};
    case ExportTarget::gltf:
      manifest["material"] = gltf_material(parameters);
      return {{name + ".glb", gltf_binary(gltf_material(parameters), name)}};
    case ExportTarget::mdl: {
      MdlModule module = mdl_module({.name = name, .brdf = brdf, .findings = {}}, options.cells, name);
      manifest["losses"] = std::move(module.losses);
      return std::move(module.files);
    }
    case ExportTarget::rgl:
      return {{name + ".bsdf", format_rgl(make_rgl_table(brdf, {.description = name}))}};
    default:
      throw Error(
          fmt::format("export: expected materialx, usda, mdl, gltf or rgl for openpbr, found {}; "
                      "`burnish fit` makes a model of it for that",
                      to_string(target)));
  }
}

}  // namespace

ExportedFiles export_openpbr(const AnalyticBrdf& brdf, const ExportOptions& options) {
  json manifest{
      {"generator", "burnish"}, {"name", options.name}, {"model", format_analytic(brdf)}, {"channels", 3}};
  ExportedFiles result;
  for (const ExportTarget target : options.to) {
    json& entry = manifest[std::string(to_string(target))];
    for (ExportedFile& file : files_of(brdf, target, options, entry)) {
      entry["files"].push_back(file.name);
      result.files.push_back(std::move(file));
    }
  }
  add_manifest(manifest, options.name, result.files);
  return result;
}

}  // namespace burnish
