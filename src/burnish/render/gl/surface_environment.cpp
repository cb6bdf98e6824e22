// SPDX-License-Identifier: Apache-2.0
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/render/gl/surface_environment.h>

namespace burnish {

namespace {

void add_tables(LightShader& shader, const std::vector<ShaderTexture>& tables) {
  for (const ShaderTexture& texture : tables)
    shader.textures.push_back(upload_of(texture, TableFormat::single, true));
}

void add_maps(LightShader& shader, const std::string& sampler, int side, int depth, std::vector<float> maps) {
  shader.textures.push_back({.name = sampler,
                             .width = 2 * side,
                             .height = side,
                             .depth = depth,
                             .channels = 3,
                             .filtered = true,
                             .values = std::move(maps)});
}

LightShader shader_of(const ImageBasedLight& light, ShaderLanguage language, const std::string& name) {
  const ImageBasedShader generated = generate_shader(light, language, name);
  LightShader shader{fmt::format("burnish_{}_light", name), {"n", "v"}, generated.text, {}};
  const int lobes = static_cast<int>(light.lobes.size());
  add_maps(shader, generated.maps, light.options.side, lobes * light.map_count() * light.options.slices,
           light.joined_maps());
  add_tables(shader, generated.tables);
  return shader;
}

LightShader shader_of(const std::pair<TappedBrdf, BlurredEnvironment>& light, ShaderLanguage language,
                      const std::string& name) {
  const auto& [brdf, blurred] = light;
  const TappedShader generated = generate_shader(brdf, blurred, language, name);
  LightShader shader{fmt::format("burnish_{}_light", name), {"n", "t", "s", "v"}, generated.text, {}};
  add_tables(shader, generated.textures);
  return shader;
}

}  // namespace

SurfaceLight::SurfaceLight(const FactoredBrdf& brdf, const Environment& environment) {
  if (brdf.isotropic())
    light_ = prefilter(brdf, environment);
  else
    light_ = std::pair(tap(brdf), blur(environment));
}

int SurfaceLight::fetches() const noexcept {
  const auto* whole = std::get_if<ImageBasedLight>(&light_);
  return whole ? whole->fetches() : std::get_if<1>(&light_)->first.fetches();
}

LightShader SurfaceLight::shader(ShaderLanguage language, const std::string& name) const {
  return std::visit([&](const auto& light) { return shader_of(light, language, name); }, light_);
}

void add_environment(SurfaceShader& surface, const FactoredBrdf& brdf, const Environment& environment) {
  LightShader shader = SurfaceLight(brdf, environment).shader(ShaderLanguage::glsl, "around");
  surface.declarations += shader.text;
  surface.environment =
      fmt::format("{}(burnish_{})", shader.function, fmt::join(shader.arguments, ", burnish_"));
  std::ranges::move(shader.textures, std::back_inserter(surface.textures));
}

}  // namespace burnish
