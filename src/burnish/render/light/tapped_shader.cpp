#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/formula/writer.h>
#include <burnish/render/light/lobe_parts.h>
#include <burnish/render/light/map_expression.h>
#include <burnish/render/light/tapped_light.h>
#include <burnish/shaders/shader_formula.h>

namespace burnish {

namespace {

// The environment at a direction of the world, blurred as wide as the level tells.
std::string blurred_function(const Language& l, const std::string& environment, const BlurOptions& blur) {
  const ExprVector w(Expr::input("w", ValueType::vector));
  const auto [x, y] = map_coordinates(w, blur.side);
  const Expr level = min(max(Expr::input("level"), 0.0), blur.levels - 1.0);
  Graph graph;
  const std::size_t root =
      graph.add(Expr::sample(environment, {x, y, (level + 0.5) * (1.0 / blur.levels)}, ValueType::vector));
  const Writer writer(l, graph, {root});
  constexpr std::array<std::string_view, 1> kParameters{"w"};
  return l.function(ValueType::vector, environment + "_at", kParameters,
                    fmt::format(fmt::runtime(l.parameter), l.scalar, "level"),
                    writer.text() + fmt::format(fmt::runtime(l.result), writer.text(root)));
}

// {0} the lobe, {1} the environment's sampler, {2} the number of taps, {3} taps, {4} levels, {5} what turns
// half vectors into directions, {6} the inner factors.
constexpr const char* kLobe = R"(
const vec4 {0}_taps[{2}] = vec4[]({3});
const float {0}_levels[{2}] = float[]({4});
vec3 {0}_gathered(vec3 wo, vec3 n, vec3 t, vec3 s) {{
  vec3 sum = vec3(0.0);
  for (int i = 0; i < {2}; ++i) {{
    vec3 wi = {0}_taps[i].xyz;
    float area = {0}_taps[i].w, level = {0}_levels[i];
{5}    if (wi.z <= 0.0) continue;
    sum += area * wi.z * {6}(wi, wo) * {1}_at(wi.x * t + wi.y * s + wi.z * n, level);
  }}
  return sum;
}}
)";

// {0}: levels an octave, halved
constexpr const char* kHalf = R"(    float along = dot(wo, wi);
    if (along <= 0.0) continue;
    wi = 2.0 * along * wi - wo;
    area *= 4.0 * along;
    level += {0:.9e} * log2(along);
)";

constexpr const char* kLight = R"(
// Radiance towards v at a point with normal n, tangent t and s at right angles to both.
vec3 burnish_{0}_light(vec3 n, vec3 t, vec3 s, vec3 v) {{
  vec3 wo = vec3(dot(t, v), dot(s, v), dot(n, v));
  if (wo.z <= 0.0) return vec3(0.0);
  return max({1}, vec3(0.0));
}}
)";

}  // namespace

TappedShader generate_shader(const TappedBrdf& brdf, const BlurOptions& blur, ShaderLanguage language,
                             const std::string& name) {
  const Language& l = burnish::language(to_string(language));
  if (language != ShaderLanguage::glsl && language != ShaderLanguage::glsl_es)
    throw Error(fmt::format("image-based light: expected glsl or glsl_es, found {}", l.name));
  TappedShader shader{.environment = fmt::format("burnish_{}_environment", name)};
  std::vector<FactoredBrdf> parts;  // outside and inside of each lobe
  for (const TappedLobe& lobe : brdf.lobes) parts.insert(parts.end(), {lobe.outside, lobe.inside});
  LobeFunctions factors = lobe_functions(
      joined(parts), {.language = language, .filter = ShaderFilter::hardware, .name = name + "_factors"});
  shader.tables = std::move(factors.textures);
  shader.text = factors.text + fmt::format(fmt::runtime(l.filtered_texture_3d), shader.environment) +
                blurred_function(l, shader.environment, blur);
  const double octave = 1 / std::log2(blur.step);  // in levels
  std::string sum;
  for (std::size_t j = 0; j < brdf.lobes.size(); ++j) {
    const TappedLobe& lobe = brdf.lobes[j];
    const std::string called = fmt::format("burnish_{}_lobe{}", name, j);
    std::string taps, levels;
    for (const LightTap& tap : lobe.taps) {
      const Vec3 w = tap.direction;
      const double width = tap.width * (lobe.of_half ? 2 : 1);
      const char* comma = taps.empty() ? "" : ", ";
      taps += fmt::format("{}vec4({:.8e}, {:.8e}, {:.8e}, {:.8e})", comma, w.x, w.y, w.z, tap.area);
      levels += fmt::format("{}{:.6e}", comma, octave * std::log2(width / blur.narrowest));
    }
    shader.text += fmt::format(fmt::runtime(kLobe), called, shader.environment, lobe.taps.size(), taps,
                               levels, lobe.of_half ? fmt::format(fmt::runtime(kHalf), 0.5 * octave) : "",
                               factors.names[2 * j + 1]);
    sum +=
        fmt::format("{}{}(wo, wo) * {}_gathered(wo, n, t, s)", j ? " + " : "", factors.names[2 * j], called);
  }
  shader.text += fmt::format(fmt::runtime(kLight), name, sum);
  return shader;
}

}  // namespace burnish
