// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/export/manifest.h>
#include <burnish/fitting/parametric/gltf_json.h>
#include <burnish/math/angles.h>
#include <burnish/shaders/cost_json.h>

namespace burnish {

namespace {

using nlohmann::json;

std::string_view extension_of(ShaderLanguage language) noexcept {
  switch (language) {
    case ShaderLanguage::glsl_es:
      return "es.glsl";
    case ShaderLanguage::msl:
      return "metal";
    case ShaderLanguage::cpp:
      return "h";
    default:
      return to_string(language);
  }
}

}  // namespace

std::string shader_file(ShaderLanguage language, const std::string& name) {
  return fmt::format("{}.{}", name, extension_of(language));
}

std::string_view kind_of(const ShaderTexture& texture) noexcept {
  return texture.depth > 0 ? "volumes" : "tables";
}

std::string texture_file(const ShaderTexture& texture, const std::string& name, std::string_view ending) {
  return fmt::format("{}.{}.{}", name, kind_of(texture), ending);
}

json manifest_entry(ShaderLanguage language, const std::string& name, const Shader& shader) {
  return {{"language", to_string(language)},
          {"file", shader_file(language, name)},
          {"functions", {"burnish_" + name, "burnish_" + name + "_world"}},
          {"cost", cost_json(shader.cost)}};
}

json manifest_entry(const std::string& file, const Texture& texture) {
  json entry{{"file", file},
             {"width", texture.width},
             {"height", texture.height},
             {"levels", texture.levels.size()},
             {"channels", texture.channels},
             {"format", to_string(texture.format)},
             {"wrap", "clamp_to_edge"},
             {"filter", texture.levels.size() > 1 ? "linear, linear between levels" : "linear"}};
  if (texture.depth > 0) entry["depth"] = texture.depth;
  return entry;
}

json manifest_entry(const Table& table) {
  json entry{{"table", table.name}, {"warp", to_string(table.layout.warp)}};
  const int projections = projection_count(table.layout.shape);
  if (projections > 1) entry["warp_y"] = to_string(table.layout.warp_y);
  if (projections > 2) entry["warp_z"] = to_string(table.layout.warp_z);
  return entry;
}

json manifest_entry(const std::string& file, const GlTexture& texture) {
  return {{"sampler", texture.name},  {"file", file},           {"width", texture.width},
          {"height", texture.height}, {"depth", texture.depth}, {"wrap", "clamp_to_edge"},
          {"filter", "linear"}};
}

json gltf_entry(const NearestGltf& nearest) {
  json entry = gltf_json(nearest.material);
  entry.update({{"psnr", nearest.psnr}, {"relative", nearest.relative}});
  return entry;
}

json errors_entry(const std::string& notes) {
  const json all = json::parse(notes, nullptr, false);
  json errors;
  if (!all.is_object()) return errors;
  for (const char* figure : {"psnr", "ssim", "relative", "rms_log", "log_cos", "relative_cross_validated",
                             "node_fit", "node_test", "node_held_out"})
    if (all.contains(figure)) errors[figure] = all[figure];
  if (!errors.is_null() && all.contains("source")) errors["source"] = all["source"];
  return errors;
}

json core_entry(const MetallicRoughness& material) {
  return {{"baseColorFactor", {material.base_color.r, material.base_color.g, material.base_color.b, 1}},
          {"metallicFactor", material.metallic},
          {"roughnessFactor", material.roughness},
          {"anisotropyStrength", material.anisotropy},
          {"anisotropyRotation", material.across ? kPi / 2 : 0.0}};
}

ExportedFile manifest_file(const json& manifest, const std::string& name) {
  return {name + ".json", manifest.dump(2, ' ', true, json::error_handler_t::replace) + "\n"};
}

}  // namespace burnish
