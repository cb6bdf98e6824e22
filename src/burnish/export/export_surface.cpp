// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/export/export_surface.h>
#include <burnish/export/gltf_binary.h>
#include <burnish/export/html_page.h>
#include <burnish/export/manifest.h>
#include <burnish/export/map_pictures.h>
#include <burnish/export/web_module.h>
#include <burnish/fitting/parametric/texel_materials.h>
#include <burnish/image/png.h>
#include <burnish/shaders/cost_json.h>
#include <burnish/shaders/spatial_shader.h>
#include <burnish/textures/dds.h>
#include <burnish/textures/image_files.h>
#include <burnish/textures/ktx2.h>

namespace burnish {

namespace {

using nlohmann::json;

json entry_of(std::span<const MapComponent> places) {
  json list = json::array();
  for (const auto& [texture, component] : places) list.push_back({texture, component});
  return list;
}

// The lobes as they are exported alone: their textures and pictures, and the manifest that this one begins with.
struct LobeFiles {
  std::vector<ExportedFile> files;
  json manifest;
};
LobeFiles lobe_files(const SpatialBrdf& surface, const ExportOptions& options) {
  ExportOptions of_lobes = options;
  of_lobes.to.clear();
  const auto wants = [&](ExportTarget target) {
    return std::ranges::find(options.to, target) != options.to.end();
  };
  const bool shaders = std::ranges::any_of(options.to, [](ExportTarget target) {
    return language_of(target).value_or(ShaderLanguage::cpp) != ShaderLanguage::cpp;
  });
  if (shaders || wants(ExportTarget::ktx2)) of_lobes.to.push_back(ExportTarget::ktx2);
  of_lobes.places = {};
  for (const ExportTarget target : {ExportTarget::dds, ExportTarget::exr, ExportTarget::png})
    if (wants(target)) of_lobes.to.push_back(target);
  ExportedFiles exported = export_model(surface.lobes(), of_lobes);
  LobeFiles lobes{.files = std::move(exported.files), .manifest = {}};
  lobes.manifest = json::parse(lobes.files.back().bytes);
  lobes.files.pop_back();
  return lobes;
}

class SurfaceExport {
 public:
  SurfaceExport(const SpatialBrdf& surface, const ExportOptions& options)
      : surface_(surface),
        options_(options),
        maps_(pack_maps(surface, fmt::format("burnish_{}_map", options.name), options.blocks)) {
    LobeFiles lobes = lobe_files(surface, options);
    result_.files = std::move(lobes.files);
    manifest_ = std::move(lobes.manifest);
    manifest_["surface"] = {{"width", surface.width()},
                            {"height", surface.height()},
                            {"bytes_a_texel", surface.weight_bytes() + surface.frame_bytes()}};
  }

  ExportedFiles run() && {
    for (const ShaderLanguage language : kShaderLanguages)
      if (std::ranges::find(options_.to, language, language_of) != options_.to.end()) add_shader(language);
    if (manifest_.contains("textures")) add_textures();
    if (options_.blocks && (surface_.width() % 4 != 0 || surface_.height() % 4 != 0))
      result_.losses.push_back(fmt::format(
          "blocks: sides of {} x {} are no multiples of 4, which WebGPU, WebGL and Direct3D ask for",
          surface_.width(), surface_.height()));
    for (const ExportTarget target : {ExportTarget::exr, ExportTarget::png})
      if (wants(target)) add_pictures(target);
    describe_maps();
    if (wants(ExportTarget::three)) add_page("three", ".three.js", three_module(surface_, options_.name));
    if (wants(ExportTarget::gltf)) add_gltf();
    if (wants(ExportTarget::html)) add_page("page", ".html", html_page(surface_, options_.name));
    result_.files.push_back(manifest_file(manifest_, options_.name));
    return std::move(result_);
  }

 private:
  bool wants(ExportTarget target) const {
    return std::ranges::find(options_.to, target) != options_.to.end();
  }

  // Adds a page that a browser opens.
  void add_page(const char* kind, const char* ending, std::string text) {
    manifest_[kind] = options_.name + ending;
    result_.files.push_back({options_.name + ending, std::move(text)});
  }

  void add_gltf() {
    const TexelMaterials materials = nearest_materials(surface_);
    manifest_["gltf"] = options_.name + ".glb";
    manifest_["gltf_material"] = {{"psnr", materials.psnr}};
    result_.files.push_back({options_.name + ".glb", gltf_binary(surface_, materials, options_.name)});
  }

  void add_shader(ShaderLanguage language) {
    const bool cpp = language == ShaderLanguage::cpp;
    const ShaderFilter filter = options_.exact || cpp ? ShaderFilter::exact : ShaderFilter::hardware;
    const SpatialShader shader = generate_shader(surface_, {.language = language,
                                                            .filter = filter,
                                                            .name = options_.name,
                                                            .maps_in_blocks = options_.blocks,
                                                            .places = options_.places,
                                                            .appended = options_.appended});
    const std::string file = shader_file(language, options_.name),
                      filter_name = filter == ShaderFilter::exact ? "exact" : "hardware";
    json textures = json::array();
    for (const ShaderTexture& texture : shader.textures)
      if (!cpp) textures.push_back(texture.name);
    for (const MapTexture& texture : shader.maps.textures) textures.push_back(texture.name);
    const std::string function = "burnish_" + options_.name;
    manifest_["shaders"].push_back(
        {{"language", to_string(language)},
         {"file", file},
         {"functions", {function + "_at", function + "_lod", function, function + "_world"}},
         {"filter", filter_name},
         {"textures", std::move(textures)},
         {"place_cost", cost_json(shader.place_cost)},
         {"cost", cost_json(shader.light_cost)}});
    result_.files.push_back({file, shader.text});
    result_.shaders.push_back({file, filter_name + " filter, once a pixel", shader.place_cost});
    result_.shaders.push_back({file, filter_name + " filter, once a light", shader.light_cost});
  }

  // Maps side by side, as shaders read them.
  void add_textures() {
    for (std::size_t i = 0; i < maps_.textures.size(); ++i) {
      const MapTexture& texture = maps_.textures[i];
      const bool in_blocks = texture.blocks != TexelBlocks::none;
      const StoredTexels texels{.format = texture.format,
                                .blocks = texture.blocks,
                                .width = texture.width,
                                .height = texture.height,
                                .levels = texture.levels};
      const std::string as_ktx2 = fmt::format("{}_map{}.ktx2", options_.name, i),
                        as_dds = fmt::format("{}_map{}.dds", options_.name, i);
      const bool dds = wants(ExportTarget::dds), ktx2 = std::ranges::any_of(options_.to, [](ExportTarget to) {
                                                   return to != ExportTarget::dds && has_map_textures(to);
                                                 });
      if (ktx2) result_.files.push_back({as_ktx2, encode_ktx2(texels, options_.compressed)});
      if (dds) result_.files.push_back({as_dds, encode_dds(texels)});
      manifest_["maps"]["textures"].push_back(
          {{"sampler", texture.name},
           {"file", ktx2 ? as_ktx2 : as_dds},
           {"width", texture.width},
           {"height", texture.height},
           {"levels", texture.levels.size()},
           {"channels", in_blocks ? 2 : 4},
           {"format", in_blocks ? to_string(texture.blocks) : to_string(texture.format)},
           {"wrap", "repeat"},
           {"filter", "linear, linear between levels"}});
      if (in_blocks) manifest_["maps"]["textures"].back()["block_rms"] = texture.block_rms;
      if (ktx2 && dds) manifest_["maps"]["textures"].back()["dds"] = as_dds;
    }
  }

  // A map a picture; three channels of two: z of a normal, 0 of a tangent.
  void add_picture(ExportTarget target, const std::string& name, const SurfaceMap& map, bool vectors,
                   bool normals) {
    const Image image = map_picture(map, normals);
    std::string bytes;
    if (target == ExportTarget::exr) {
      bytes = encode_exr(image, TableFormat::single);
    } else if (vectors) {
      bytes = encode_png(vector_bytes(image), PngValues::linear);
    } else {
      float most = map.scale();
      if (map.format() == TableFormat::half) most = std::max(*std::ranges::max_element(image.pixels), 1e-30f);
      Image8 shown(map.width(), map.height(), 3);
      for (std::size_t i = 0; i < shown.pixels.size(); ++i)
        shown.pixels[i] =
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(image.pixels[i] / most, 0.0f, 1.0f)));
      bytes = encode_png(shown, PngValues::linear);
    }
    const std::string file = fmt::format("{}_{}.{}", options_.name, name, to_string(target));
    manifest_["map_images"].push_back({{"map", name}, {"file", file}});
    result_.files.push_back({file, std::move(bytes)});
  }
  void add_pictures(ExportTarget target) {
    const SurfaceMaps& maps = surface_.maps();
    for (std::size_t j = 0; j < surface_.own_lobes(); ++j)
      add_picture(target, fmt::format("weight{}", j), maps.weights[j], false, false);
    if (maps.normals) add_picture(target, "normals", *maps.normals, true, true);
    if (maps.tangents) add_picture(target, "tangents", *maps.tangents, true, false);
  }

  void describe_maps() {
    json& entry = manifest_["maps"];
    for (std::size_t j = 0; j < maps_.weights.size(); ++j) {
      const SurfaceMap& map = surface_.maps().weights[j];
      entry["weights"].push_back(
          {{"places", entry_of(std::span(maps_.weights[j]).first(map.channels()))}, {"scale", map.scale()}});
    }
    if (maps_.normals) entry["normals"] = entry_of(*maps_.normals);
    if (maps_.tangents) entry["tangents"] = entry_of(*maps_.tangents);
  }

  const SpatialBrdf& surface_;
  const ExportOptions& options_;
  PackedMaps maps_;
  json manifest_;
  ExportedFiles result_;
};

}  // namespace

bool has_map_textures(ExportTarget target) noexcept {
  return target == ExportTarget::ktx2 || target == ExportTarget::dds ||
         language_of(target).value_or(ShaderLanguage::cpp) != ShaderLanguage::cpp;
}

bool takes_surfaces(ExportTarget target) noexcept {
  using enum ExportTarget;
  return language_of(target) || target == ktx2 || target == dds || target == exr || target == png ||
         target == three || target == html || target == gltf;
}

ExportedFiles export_surface(const SpatialBrdf& surface, const ExportOptions& options) {
  if (options.environment) throw Error("environment: expected a model with it, found a surface");
  if (options.half) throw Error("export: expected a model with half products, found a surface");
  if (options.sample)
    throw Error("export: expected a model with functions that draw directions, found a surface");
  if (options.blocks && std::ranges::none_of(options.to, has_map_textures))
    throw Error("blocks: expected ktx2, dds or a shader language to export, found " + names_of(options.to));
  check_places_shown(options);
  for (const ExportTarget target : options.to)
    if (!takes_surfaces(target))
      throw Error(
          fmt::format("export: expected ktx2, dds, exr, png, gltf, three, html or a shader language of a "
                      "surface, found {}",
                      to_string(target)));
  return SurfaceExport(surface, options).run();
}

}  // namespace burnish
