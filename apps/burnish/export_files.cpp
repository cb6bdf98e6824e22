#include "export_files.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/textures/ktx2.h>

namespace burnish::cli {

namespace {

constexpr float kLargestHalf = 65504;

nlohmann::json table_entry(const Table& table) {
  nlohmann::json entry{{"table", table.name}, {"warp", to_string(table.layout.warp)}};
  if (table.layout.shape == TableShape::grid) entry["warp_y"] = to_string(table.layout.warp_y);
  return entry;
}

}  // namespace

void add_textures(const FactoredBrdf& brdf, const ExportArguments& arguments,
                  std::vector<ExportedFile>& files, nlohmann::json& manifest) {
  const Shader shader = generate_shader(brdf, {.name = arguments.name});
  for (std::size_t i = 0; i < shader.textures.size(); ++i) {
    const ShaderTexture& shown = shader.textures[i];
    const bool alone = shown.tables.size() == 1;
    if (!alone && arguments.mips)
      throw Error("export: expected a model of at most 16 tables with --mips: more share textures");
    const Texture texture = alone ? make_texture(brdf.tables()[shown.tables[0]], arguments.mips)
                                  : Texture{.format = shown.format,
                                            .channels = shown.channels,
                                            .width = shown.width,
                                            .height = shown.height,
                                            .levels = {shown.values}};
    files.push_back({fmt::format("{}_{}.ktx2", arguments.name, i), encode_ktx2(texture, !arguments.plain)});
    nlohmann::json entry{{"file", files.back().name},    {"width", texture.width},
                         {"height", texture.height},     {"levels", texture.levels.size()},
                         {"channels", texture.channels}, {"format", to_string(texture.format)},
                         {"wrap", "clamp_to_edge"}};
    if (alone) entry.update(table_entry(brdf.tables()[shown.tables[0]]));
    for (std::size_t k = 0; !alone && k < shown.tables.size(); ++k) {
      const Table& table = brdf.tables()[shown.tables[k]];
      entry["tables"].push_back(table_entry(table));
      entry["tables"].back().update({{"first_row", shown.first_rows[k]}, {"rows", table.layout.height}});
    }
    manifest["textures"].push_back(entry);
  }
}

void add_light(const SurfaceLight& light, const ExportArguments& arguments, std::vector<ExportedFile>& files,
               nlohmann::json& manifest) {
  nlohmann::json entry{{"environment", arguments.environment}, {"fetches", light.fetches()}};
  std::vector<GlTexture> textures;
  for (const ExportTarget& target : kExportTargets) {
    const bool glsl = target.language == ShaderLanguage::glsl || target.language == ShaderLanguage::glsl_es;
    if (!glsl || std::ranges::find(arguments.to, target.name) == arguments.to.end()) continue;
    LightShader shader = light.shader(target.language, arguments.name);
    files.push_back({fmt::format("{}.light.{}", arguments.name, target.extension), shader.text});
    entry["shaders"].push_back({{"language", target.name},
                                {"file", files.back().name},
                                {"function", shader.function},
                                {"arguments", shader.arguments}});
    textures = std::move(shader.textures);
  }
  for (std::size_t i = 0; i < textures.size(); ++i) {
    GlTexture& texture = textures[i];
    for (float& value : texture.values) value = std::clamp(value, -kLargestHalf, kLargestHalf);
    files.push_back({fmt::format("{}.light_{}.ktx2", arguments.name, i),
                     encode_ktx2({.format = TableFormat::half,
                                  .channels = texture.channels,
                                  .width = texture.width,
                                  .height = texture.height,
                                  .depth = texture.depth,
                                  .levels = {std::move(texture.values)}},
                                 !arguments.plain)});
    entry["textures"].push_back({{"sampler", texture.name},
                                 {"file", files.back().name},
                                 {"width", texture.width},
                                 {"height", texture.height},
                                 {"depth", texture.depth},
                                 {"wrap", "clamp_to_edge"}});
  }
  manifest["light"] = entry;
}

}  // namespace burnish::cli
