// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <burnish/render/gl/surface_shader.h>
#include <burnish/render/glsl_files.h>
#include <burnish/shaders/spatial_shader.h>

namespace burnish {

namespace {

constexpr const char* kSurfaceName = "model";

// Texture coordinates have v upwards, maps downwards. The level of detail is the larger step of a pixel, in texels; what
// it is made of is asked for before anything branches.
std::string placed(const SurfaceShader& surface) {
  if (surface.place.empty()) return {};
  return fmt::format(
      "  float u = burnish_uv.x, v = 1.0 - burnish_uv.y;\n"
      "  vec2 burnish_dx = dFdx(burnish_uv), burnish_dy = dFdy(burnish_uv);\n"
      "  float lod = burnish_{}_lod(burnish_dx.x, burnish_dx.y, burnish_dy.x, burnish_dy.y);\n{}",
      kSurfaceName, surface.place);
}

}  // namespace

std::string scene_vertex_shader() {
  return std::string(text_of(glsl_files(), "scene.vert.glsl"));
}

std::string interpolated_fragment_shader() {
  return std::string(text_of(glsl_files(), "interpolated.frag.glsl"));
}

std::string scene_fragment_shader(const SurfaceShader& surface) {
  const std::string& around = surface.environment;
  return with_marks(
      text_of(glsl_files(), "surface.frag.glsl"),
      {{"DECLARATIONS", surface.declarations},
       {"PLACE", placed(surface)},
       {"ENVIRONMENT", around.empty() ? "" : fmt::format("  if (burnish_first) burnish_sum = {};", around)},
       {"VIEW", surface.view},
       {"LIGHT", surface.light},
       {"VALUE", surface.value}});
}

SurfaceShader surface_shader(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision) {
  const bool filtered = filter == ShaderFilter::hardware;
  const SplitShader split = split_shader(brdf, {.filter = filter, .name = "model", .lines_are_1d = filtered});
  SurfaceShader surface{split.declarations, split.view, split.light, split.value, {}};
  for (const ShaderTexture& texture : split.textures)
    surface.textures.push_back(upload_of(texture, precision, filtered));
  return surface;
}

SurfaceShader surface_shader(const SpatialBrdf& surface, ShaderFilter filter, TableFormat precision) {
  const bool filtered = filter == ShaderFilter::hardware;
  SplitSpatialShader split =
      split_shader(surface, {.filter = filter, .name = kSurfaceName, .lines_are_1d = filtered});
  SurfaceShader shader{.declarations = split.declarations,
                       .view = split.lobes.view,
                       .light = split.lobes.light,
                       .value = split.lobes.value,
                       .textures = {},
                       .place = std::move(split.place)};
  // the place's frame in the mesh's
  if (split.framed)
    shader.place +=
        "  mat3 burnish_turn = mat3(burnish_t, burnish_s, burnish_n);\n"
        "  burnish_t = burnish_turn * place.t;\n"
        "  burnish_s = burnish_turn * place.b;\n"
        "  burnish_n = burnish_turn * place.n;\n";
  for (const ShaderTexture& texture : split.lobes.textures)
    shader.textures.push_back(upload_of(texture, precision, filtered));
  shader.maps = std::move(split.maps.textures);
  return shader;
}

}  // namespace burnish
