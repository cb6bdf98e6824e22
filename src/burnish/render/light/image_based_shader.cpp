#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/render/gl/gl_evaluator.h>
#include <burnish/render/light/image_based_light.h>

namespace burnish {

namespace {

// The radiance through one lobe's maps. {0} the lobe, {1} slices, {2} the axes, {3} side, {4} depth, {5}
// orders, {6} the sampler, {7} the lobe's first slice.
constexpr const char* kLobe = R"(
vec3 {0}_seen(vec3 n, vec3 plane, float slice) {{
  const float axes[{1}] = float[]({2});
  int low = min(int(slice), {1} - 2);
  float angle = mix(axes[low], axes[low + 1], slice - float(low));
  vec3 axis = cos(angle) * n + sin(angle) * plane, tilt = cos(angle) * plane - sin(angle) * n;
  float first = 0.5;
  if (axis.y < 0.0) {{ axis.y = -axis.y; tilt.y = -tilt.y; first += {3}.0; }}
  float a = 1.0 / (1.0 + axis.y);
  vec3 u = vec3(1.0 - axis.x * axis.x * a, -axis.x, -axis.x * axis.z * a);
  vec3 w = vec3(-axis.x * axis.z * a, -axis.z, 1.0 - axis.z * axis.z * a);
  vec2 turn = vec2(dot(tilt, u), dot(tilt, w)), part = turn;
  vec2 at = (a * axis.xz + 1.0) * (0.5 * float({3} - 1));
  vec3 place = vec3((first + at.x) / float(2 * {3}), (0.5 + at.y) / float({3}), ({7}.5 + slice) / float({4}));
  vec3 sum = textureLod({6}, place, 0.0).rgb;
  for (int m = 1; m <= {5}; ++m) {{
    place.z += float({1}) / float({4});
    sum += part.x * textureLod({6}, place, 0.0).rgb;
    place.z += float({1}) / float({4});
    sum += part.y * textureLod({6}, place, 0.0).rgb;
    part = vec2(turn.x * part.x - turn.y * part.y, turn.y * part.x + turn.x * part.y);
  }}
  return sum;
}}
)";

constexpr const char* kLight = R"(
// Radiance towards v at normal n, of the light that the maps were made from.
vec3 burnish_{0}_light(vec3 n, vec3 v) {{
  float cos_o = min(dot(n, v), 1.0);
  if (cos_o <= 0.0) return vec3(0.0);
  vec3 away = cos_o * n - v;
  float sin_o = length(away);
  vec3 plane = away / max(sin_o, 1e-6), wo = vec3(-sin_o, 0.0, cos_o);
  float slice = sin_o / (1.0 + cos_o) * {1}.0;
  return max({2}, vec3(0.0));
}}
)";

}  // namespace

ImageBasedShader generate_shader(const ImageBasedLight& light, ShaderLanguage language,
                                 const std::string& name) {
  if (language != ShaderLanguage::glsl && language != ShaderLanguage::glsl_es)
    throw Error(fmt::format("image-based light: expected glsl or glsl_es, found {}", to_string(language)));
  // all lobes' maps are slices of one texture
  const auto& [slices, side, harmonics] = light.options;
  const int slices_a_lobe = light.map_count() * slices;
  const int depth = static_cast<int>(light.lobes.size()) * slices_a_lobe;
  ImageBasedShader shader{.maps = fmt::format("burnish_{}_maps", name)};

  // every lobe: the factors of the view and the look at its maps
  std::string sum;
  for (std::size_t j = 0; j < light.lobes.size(); ++j) {
    const PrefilteredLobe& lobe = light.lobes[j];
    const std::string outside = fmt::format("{}_lobe{}", name, j);
    const Shader view = generate_shader(lobe.outside, {language, ShaderFilter::hardware, outside});
    std::string axes;
    for (const double angle : lobe.axis) axes += fmt::format("{}{:.9e}", axes.empty() ? "" : ", ", angle);
    shader.text += view.text;
    if (j == 0) shader.text += fmt::format("uniform highp sampler3D {};", shader.maps);
    shader.text += fmt::format(fmt::runtime(kLobe), "burnish_" + outside, slices, axes, side, depth,
                               harmonics, shader.maps, static_cast<int>(j) * slices_a_lobe);
    std::ranges::copy(view.textures, std::back_inserter(shader.tables));
    sum += fmt::format("{0}burnish_{1}(wo, wo) * burnish_{1}_seen(n, plane, slice)", j ? " + " : "", outside);
  }
  shader.text += fmt::format(fmt::runtime(kLight), name, slices - 1, sum);
  return shader;
}

GlImageBasedLight::GlImageBasedLight(const ImageBasedLight& light)
    : GlImageBasedLight(light, generate_shader(light, ShaderLanguage::glsl, "model")) {}

GlImageBasedLight::GlImageBasedLight(const ImageBasedLight& light, const ImageBasedShader& shader)
    : function_(shader.text, "burnish_model_light") {
  const int side = light.options.side;
  function_.set_texture(
      {.name = shader.maps,
       .width = 2 * side,
       .height = side,
       .depth = static_cast<int>(light.lobes.size()) * light.map_count() * light.options.slices,
       .channels = 3,
       .precision = TableFormat::half,
       .filtered = true,
       .values = light.joined_maps()});
  set_textures(function_, shader.tables, TableFormat::half, true);
}

}  // namespace burnish
