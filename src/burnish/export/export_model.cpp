// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/export/export_model.h>
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
#include <burnish/lighting/area_light_fit.h>
#include <burnish/lighting/area_light_shader.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/render/gl/surface_environment.h>
#include <burnish/shaders/shader.h>
#include <burnish/textures/dds.h>
#include <burnish/textures/image_files.h>
#include <burnish/textures/ktx2.h>

namespace burnish {

namespace {

using nlohmann::json;

constexpr float kMaxHalf = 65504;

// Files so far and what the manifest says of them.
class ModelExport {
 public:
  ModelExport(const FactoredBrdf& brdf, const ExportOptions& options)
      : brdf_(brdf),
        options_(options),
        manifest_{{"generator", "burnish"},
                  {"name", options.name},
                  {"model", model_expression(brdf)},
                  {"channels", brdf.channels()},
                  {"table_bytes", brdf.table_bytes()}} {
    if (json errors = errors_entry(options.notes); !errors.is_null()) manifest_["errors"] = std::move(errors);
  }

  ExportedFiles run() &&;

 private:
  bool wants(ExportTarget target) const {
    return std::ranges::find(options_.to, target) != options_.to.end();
  }
  bool wants(ShaderLanguage language) const {
    return std::ranges::find(options_.to, language, language_of) != options_.to.end();
  }
  // The last file's name.
  const std::string& add(std::string name, std::string bytes) {
    return result_.files.emplace_back(ExportedFile{std::move(name), std::move(bytes)}).name;
  }

  void add_shader(ShaderLanguage language);
  void add_textures(bool ktx2, bool dds);
  void add_levels();
  void add_cube_maps();
  void add_images(ExportTarget target, std::string (*encode)(const Table& table));
  const MetallicRoughnessFit& core();
  const NearestOpenPbr& openpbr();
  void add_gltf();
  void add_materialx();
  void add_mdl();
  void add_rgl();
  void add_light(const SurfaceLight& light);
  void add_area_lights();

  const FactoredBrdf& brdf_;
  const ExportOptions& options_;
  json manifest_;
  ExportedFiles result_;
  // found when first asked for
  std::optional<MetallicRoughnessFit> core_;
  std::optional<NearestOpenPbr> openpbr_;
};

void ModelExport::add_shader(ShaderLanguage language) {
  const bool cpp = language == ShaderLanguage::cpp;
  const ShaderFilter filter = options_.exact || cpp ? ShaderFilter::exact : ShaderFilter::hardware;
  const bool half = options_.half && !cpp;
  const Shader shader = generate_shader(brdf_, {.language = language,
                                                .filter = filter,
                                                .name = options_.name,
                                                .half_products = half,
                                                .places = options_.places,
                                                .appended = options_.appended});
  const char* filter_name = filter == ShaderFilter::exact ? "exact" : "hardware";

  json entry = manifest_entry(language, options_.name, shader);
  entry["filter"] = filter_name;
  if (half) entry["products"] = "half";
  for (const ShaderTexture& texture : shader.textures)
    if (!cpp) entry["textures"].push_back(texture.name);
  manifest_["shaders"].push_back(std::move(entry));

  const std::string& file = add(shader_file(language, options_.name), shader.text);
  result_.shaders.push_back(
      {file, fmt::format("{} filter{}", filter_name, half ? ", half products" : ""), shader.cost});
}

// Adds the textures that generated shaders read, in either format or both.
void ModelExport::add_textures(bool ktx2, bool dds) {
  const Shader shader = generate_shader(brdf_, {.name = options_.name});
  for (const ShaderTexture& shown : shader.textures) {
    const Texture texture{.format = shown.format,
                          .channels = shown.channels,
                          .width = shown.width,
                          .height = shown.height,
                          .depth = shown.depth,
                          .levels = {shown.values}};
    const std::string as_ktx2 = texture_file(shown, options_.name, "ktx2"),
                      as_dds = texture_file(shown, options_.name, "dds");
    if (ktx2) add(as_ktx2, encode_ktx2(texture, options_.compressed));
    if (dds) add(as_dds, encode_dds(texture));

    // where each table's nodes are
    json entry = manifest_entry(ktx2 ? as_ktx2 : as_dds, texture);
    if (ktx2 && dds) entry["dds"] = as_dds;
    if (options_.exact) entry["filter"] = "any";
    entry["sampler"] = shown.name;
    for (const PlacedTable& placed : shown.tables) {
      const TableLayout& layout = brdf_.tables()[placed.table].layout;
      json place = manifest_entry(brdf_.tables()[placed.table]);
      place.update({{"first", placed.first},
                    {"nodes", {layout.width, layout.height, layout.depth}},
                    {"exponent", placed.exponent}});
      entry["tables"].push_back(std::move(place));
    }
    manifest_["textures"].push_back(std::move(entry));
  }
}

// A table a texture, with its levels.
void ModelExport::add_levels() {
  for (std::size_t i = 0; i < brdf_.tables().size(); ++i) {
    const Table& table = brdf_.tables()[i];
    const Texture texture = make_texture(table, true);
    const std::string& file =
        add(fmt::format("{}_{}.mips.ktx2", options_.name, i), encode_ktx2(texture, options_.compressed));
    json entry = manifest_entry(file, texture);
    entry.update(manifest_entry(table));
    manifest_["mips"].push_back(std::move(entry));
  }
}

void ModelExport::add_cube_maps() {
  for (std::size_t i = 0; i < brdf_.tables().size(); ++i) {
    const Table& table = brdf_.tables()[i];
    if (projection_count(table.layout.shape) > 1) continue;  // of several directions
    // twice as fine at the normal as a disk without a warp
    const Texture cube = make_cube_map(
        table, static_cast<int>(std::bit_ceil(static_cast<unsigned>(table.layout.width))), options_.mips);
    const std::string& file =
        add(fmt::format("{}_{}.cube.ktx2", options_.name, i), encode_ktx2(cube, options_.compressed));
    manifest_["cube_maps"].push_back({{"table", table.name},
                                      {"file", file},
                                      {"side", cube.width},
                                      {"levels", cube.levels.size()},
                                      {"format", to_string(table.format)}});
  }
}

// A table a picture.
void ModelExport::add_images(ExportTarget target, std::string (*encode)(const Table& table)) {
  for (std::size_t i = 0; i < brdf_.tables().size(); ++i) {
    const Table& table = brdf_.tables()[i];
    const std::string& file =
        add(fmt::format("{}_{}.{}", options_.name, i, to_string(target)), encode(table));
    manifest_["images"].push_back({{"table", table.name}, {"file", file}});
  }
}

// The core material of glTF that looks most alike.
const MetallicRoughnessFit& ModelExport::core() {
  if (!core_) {
    core_ = fit_metallic_roughness(brdf_);
    json entry = core_entry(core_->material);
    entry["psnr"] = core_->psnr;
    manifest_["core_material"] = std::move(entry);
  }
  return *core_;
}

// The parameters of OpenPBR that look most alike.
const NearestOpenPbr& ModelExport::openpbr() {
  if (!openpbr_) {
    openpbr_ = nearest_openpbr(brdf_);
    manifest_["openpbr"] = {{"spec", format_analytic(analytic_openpbr(openpbr_->parameters))},
                            {"psnr", openpbr_->psnr}};
  }
  return *openpbr_;
}

void ModelExport::add_gltf() {
  const NearestGltf nearest = nearest_gltf(brdf_);
  manifest_["gltf"] =
      add(options_.name + ".glb", gltf_binary(brdf_, gltf_json(nearest.material), options_.name));
  manifest_["gltf_material"] = gltf_entry(nearest);
}

void ModelExport::add_materialx() {
  const ShaderFilter filter = options_.exact ? ShaderFilter::exact : ShaderFilter::hardware;
  for (ExportedFile& file : materialx_files(brdf_, core().material, filter, options_.name))
    manifest_["materialx"].push_back(add(std::move(file.name), std::move(file.bytes)));
}

void ModelExport::add_mdl() {
  MdlModule module = mdl_module(to_source(options_.name, {brdf_, {}, {}}), options_.cells, options_.name);
  for (ExportedFile& file : module.files)
    manifest_["mdl"]["files"].push_back(add(std::move(file.name), std::move(file.bytes)));
  result_.lose(options_.name + ".mbsdf", module.losses);
  manifest_["mdl"]["losses"] = std::move(module.losses);
}

void ModelExport::add_rgl() {
  Converted table = convert({.name = options_.name, .brdf = brdf_, .findings = {}}, "rgl", {});
  manifest_["rgl"] = add(options_.name + ".bsdf", std::move(table.bytes));
  result_.lose(options_.name + ".bsdf", table.losses);
}

// Shaders of the light that comes from all around, as far as their languages are asked for, and its textures.
void ModelExport::add_light(const SurfaceLight& light) {
  json entry{{"environment", options_.environment->name}, {"fetches", light.fetches()}};
  std::vector<GlTexture> textures;
  for (const ShaderLanguage language : {ShaderLanguage::glsl, ShaderLanguage::glsl_es}) {
    if (!wants(language)) continue;
    LightShader shader = light.shader(language, options_.name);
    const std::string& file = add(shader_file(language, options_.name + ".light"), shader.text);
    entry["shaders"].push_back({{"language", to_string(language)},
                                {"file", file},
                                {"function", shader.function},
                                {"arguments", shader.arguments}});
    textures = std::move(shader.textures);  // the same for both
  }
  for (std::size_t i = 0; i < textures.size(); ++i) {
    GlTexture& texture = textures[i];
    for (float& value : texture.values) value = std::clamp(value, -kMaxHalf, kMaxHalf);
    const std::string& file = add(fmt::format("{}.light_{}.ktx2", options_.name, i),
                                  encode_ktx2({.format = TableFormat::half,
                                               .channels = texture.channels,
                                               .width = texture.width,
                                               .height = texture.height,
                                               .depth = texture.depth,
                                               .levels = {std::move(texture.values)}},
                                              options_.compressed));
    entry["textures"].push_back(manifest_entry(file, texture));
  }
  manifest_["light"] = std::move(entry);
}

// Functions of area lights in every language that has textures, and the texture that all of them read.
void ModelExport::add_area_lights() {
  const AreaLightTable table = fit_area_lights(brdf_);
  json entry{{"lobes", table.lobes.size()}, {"table_bytes", table.bytes()}};
  ShaderTexture texture;
  for (const ShaderLanguage language : kShaderLanguages) {
    if (!wants(language) || language == ShaderLanguage::cpp) continue;
    AreaLightShader shader = generate_shader(table, language, options_.name, options_.places);
    const std::string& file = add(shader_file(language, options_.name + ".area"), shader.text);
    result_.shaders.push_back({file, "area lights", shader.cost});
    entry["shaders"].push_back({{"file", file},
                                {"function", fmt::format("burnish_{}_quad", options_.name)},
                                {"arguments", {"wo", "p0", "p1", "p2", "p3"}},
                                {"world_function", fmt::format("burnish_{}_quad_world", options_.name)}});
    texture = std::move(shader.texture);  // the same for all
  }
  const Texture stored{.format = texture.format,
                       .channels = texture.channels,
                       .width = texture.width,
                       .height = texture.height,
                       .depth = 0,
                       .levels = {std::move(texture.values)}};
  const std::string& file = add(options_.name + ".area.ktx2", encode_ktx2(stored, options_.compressed));
  entry["texture"] = manifest_entry(file, stored);
  entry["texture"]["sampler"] = texture.name;
  manifest_["area"] = std::move(entry);
}

ExportedFiles ModelExport::run() && {
  // shaders and what they read
  bool textures = wants(ExportTarget::ktx2);
  for (const ShaderLanguage language : kShaderLanguages) {
    if (!wants(language)) continue;
    add_shader(language);
    textures = textures || language != ShaderLanguage::cpp;
  }
  const bool dds = wants(ExportTarget::dds);
  if (textures || dds) add_textures(textures, dds);
  if (textures && options_.mips) add_levels();

  if (options_.area) add_area_lights();
  if (options_.sample) add_sampler(brdf_, options_, result_, manifest_);

  // tables in other formats
  const std::string& name = options_.name;
  if (wants(ExportTarget::cube)) add_cube_maps();
  if (wants(ExportTarget::exr)) add_images(ExportTarget::exr, encode_exr);
  if (wants(ExportTarget::png)) add_images(ExportTarget::png, encode_png_table);

  // materials of other programs
  if (wants(ExportTarget::gltf)) add_gltf();
  if (wants(ExportTarget::materialx)) add_materialx();
  if (wants(ExportTarget::usda))
    manifest_["usda"] = add(name + ".usda", usda_layer(openpbr().parameters, core().material, name));
  if (wants(ExportTarget::mdl)) add_mdl();
  if (wants(ExportTarget::three))
    manifest_["three"] = add(name + ".three.js", three_module(brdf_, core().material, name));
  if (wants(ExportTarget::babylon))
    manifest_["babylon"] = add(name + ".babylon.js", babylon_module(brdf_, name));
  if (wants(ExportTarget::rgl)) add_rgl();

  // light from all around, for the page too
  std::optional<SurfaceLight> light;
  if (options_.environment) {
    light.emplace(brdf_, *options_.environment);
    add_light(*light);
  }
  if (wants(ExportTarget::html))
    manifest_["page"] = add(name + ".html", html_page(brdf_, name, light ? &*light : nullptr));

  result_.files.push_back(manifest_file(manifest_, name));
  return std::move(result_);
}

}  // namespace

void check_places_shown(const ExportOptions& options) {
  const auto check = [&](const char* what, const std::optional<int>& number,
                         bool (*has)(ExportTarget target) noexcept) {
    if (number && std::ranges::none_of(options.to, has))
      throw Error(fmt::format("export: expected {} with a {}, found {}", targets_that(has), what,
                              names_of(options.to)));
    if (number && options.environment)
      throw Error(fmt::format("export: expected no environment with a {}, found one", what));
  };
  check("binding", options.places.binding, has_bindings);
  check("set", options.places.set, has_sets);
  check("space", options.places.space, has_spaces);
}

ExportedFiles export_model(const FactoredBrdf& brdf, const ExportOptions& options) {
  if (options.environment && std::ranges::none_of(options.to, shows_environment))
    throw Error(fmt::format("environment: expected {} with it, found {}", targets_that(shows_environment),
                            names_of(options.to)));
  if (options.area && std::ranges::none_of(options.to, has_half_products))
    throw Error(fmt::format("export: expected {} with area lights, found {}", targets_that(has_half_products),
                            names_of(options.to)));
  if (options.half && std::ranges::none_of(options.to, has_half_products))
    throw Error(fmt::format("export: expected {} with half products, found {}",
                            targets_that(has_half_products), names_of(options.to)));
  check_places_shown(options);
  return ModelExport(brdf, options).run();
}

}  // namespace burnish
