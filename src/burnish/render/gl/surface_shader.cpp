#include <fmt/format.h>

#include <burnish/render/gl/surface_shader.h>
#include <burnish/render/glsl_files.h>

namespace burnish {

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

}  // namespace burnish
