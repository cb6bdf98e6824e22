#include <burnish/render/image_based_light.h>
#include <burnish/render/surface_environment.h>
#include <burnish/render/tapped_light.h>

namespace burnish {

namespace {

constexpr const char* kName = "around";

void add_tables(SurfaceShader& surface, const FactoredBrdf& brdf, const std::vector<std::string>& samplers) {
  for (std::size_t i = 0; i < samplers.size(); ++i) {
    const Table& table = brdf.tables()[i];
    surface.textures.push_back({.name = samplers[i],
                                .width = table.layout.width,
                                .height = table.layout.height,
                                .channels = table.channels,
                                .filtered = true,
                                .values = table.values});
  }
}

void add_maps(SurfaceShader& surface, const std::string& sampler, int side, int depth,
              const std::vector<float>& maps) {
  surface.textures.push_back({.name = sampler,
                              .width = 2 * side,
                              .height = side,
                              .depth = depth,
                              .channels = 3,
                              .filtered = true,
                              .values = maps});
}

}  // namespace

void add_environment(SurfaceShader& surface, const FactoredBrdf& brdf, const Environment& environment) {
  if (brdf.isotropic()) {
    const ImageBasedLight light = prefilter(brdf, environment);
    const ImageBasedShader shader = generate_shader(light, ShaderLanguage::glsl, kName);
    surface.declarations += shader.text;
    surface.environment = "burnish_around_light(burnish_n, burnish_v)";
    for (std::size_t j = 0; j < light.lobes.size(); ++j) {
      add_maps(surface, shader.lobes[j].maps, light.options.side, light.map_count() * light.options.slices,
               light.lobes[j].maps);
      add_tables(surface, light.lobes[j].outside, shader.lobes[j].tables);
    }
    return;
  }
  const BlurredEnvironment blurred = blur(environment);
  const TappedBrdf tapped = tap(brdf);
  const TappedShader shader = generate_shader(tapped, blurred.options, ShaderLanguage::glsl, kName);
  surface.declarations += shader.text;
  surface.environment = "burnish_around_light(burnish_n, burnish_t, burnish_s, burnish_v)";
  add_maps(surface, shader.environment, blurred.options.side, blurred.options.levels, blurred.maps);
  for (std::size_t j = 0; j < tapped.lobes.size(); ++j) {
    add_tables(surface, tapped.lobes[j].outside, shader.lobes[j].outside);
    add_tables(surface, tapped.lobes[j].inside, shader.lobes[j].inside);
  }
}

}  // namespace burnish
