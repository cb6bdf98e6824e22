#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/formula/writer.h>
#include <burnish/render/glsl_files.h>
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

// Statements that end in `name`, a local.
std::string declared(const Language& l, ValueType type, const std::string& name, const Expr& value) {
  Graph graph;
  const std::size_t root = graph.add(value);
  const Writer writer(l, graph, {root});
  const std::string last = writer.text(root);
  return writer.text() + (last == name ? "" : l.declaration(type, name, last));
}

// The light that one tap stands for, over the inputs of tapped.glsl; `octave` is of the environment's levels.
Expr light_of_tap(bool of_half, double octave, const std::string& inside, const std::string& environment) {
  const ExprVector wi(Expr::input("wi", ValueType::vector)), n(Expr::input("n", ValueType::vector)),
      t(Expr::input("t", ValueType::vector)), s(Expr::input("s", ValueType::vector));
  Expr area = Expr::input("area"), level = Expr::input("level");
  // between half vectors and directions to the light: d wi = 4 (wo . h) d h, and cones open and close by its root
  if (of_half) {
    const Expr along = Expr::input("along");
    area = area * (4.0 * along);
    level = level + 0.5 * octave * Expr(Op::log2, {along});
  }
  const ExprVector world = wi.x * t + wi.y * s + wi.z * n;
  return area * wi.z *
         (Expr::call(inside, {wi.whole(), Expr::input("wo", ValueType::vector)}, ValueType::vector) *
          Expr::call(environment + "_at", {world.whole(), level}, ValueType::vector));
}

// The function NAME_gathered of one lobe.
std::string gathered_function(const Language& l, const TappedLobe& lobe, const std::string& name,
                              const std::string& inside, const std::string& environment,
                              const BlurOptions& blur) {
  const double octave = 1 / std::log2(blur.step);  // in levels
  std::string taps, levels;
  for (const LightTap& tap : lobe.taps) {
    const Vec3 w = tap.direction;
    const double width = tap.width * (lobe.of_half ? 2 : 1);
    const char* comma = taps.empty() ? "" : ", ";
    taps += fmt::format("{}vec4({:.8e}, {:.8e}, {:.8e}, {:.8e})", comma, w.x, w.y, w.z, tap.area);
    levels += fmt::format("{}{:.6e}", comma, octave * std::log2(width / blur.narrowest));
  }

  // the direction to the light; below the horizon where the half vector turns away from wo, which is above
  const ExprVector tap(Expr::input("tap", ValueType::vector)), wo(Expr::input("wo", ValueType::vector));
  Expr wi = tap.whole();
  if (lobe.of_half) {
    const Expr along = named("along", dot(wo, tap));
    wi = named("wi", (2.0 * along * tap - wo).whole());
  }
  Graph graph;
  const std::size_t root = graph.add(light_of_tap(lobe.of_half, octave, inside, environment));
  const Writer light(l, graph, {root});
  return with_marks(text_of(glsl_files(), "tapped.glsl"),
                    {{"LOBE", name},
                     {"COUNT", std::to_string(lobe.taps.size())},
                     {"TAPS", taps},
                     {"LEVELS", levels},
                     {"DIRECTION", declared(l, ValueType::vector, "wi", wi)},
                     {"LIGHT", light.text()},
                     {"VALUE", light.text(root)}});
}

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

  // the view as all lobes have it, then each lobe's factors of the view times what its taps gather
  const ExprVector v(Expr::input("v", ValueType::vector));
  const auto along = [&](const char* axis) {
    return dot(ExprVector(Expr::input(axis, ValueType::vector)), v);
  };
  const Expr wo = named("wo", ExprVector(along("t"), along("s"), along("n"))).whole();
  Expr sum;
  for (std::size_t j = 0; j < brdf.lobes.size(); ++j) {
    const std::string name_of_lobe = fmt::format("burnish_{}_lobe{}", name, j);
    shader.text +=
        gathered_function(l, brdf.lobes[j], name_of_lobe, factors.names[2 * j + 1], shader.environment, blur);
    std::vector<Expr> arguments{wo};
    for (const char* axis : {"n", "t", "s"}) arguments.push_back(Expr::input(axis, ValueType::vector));
    sum = sum + Expr::call(factors.names[2 * j], {wo, wo}, ValueType::vector) *
                    Expr::call(name_of_lobe + "_gathered", arguments, ValueType::vector);
  }
  Graph graph;
  const std::size_t root = graph.add(max(sum, Expr(Op::vector, {0.0, 0.0, 0.0})));
  const Writer writer(l, graph, {root});
  constexpr std::array<std::string_view, 4> kParameters{"n", "t", "s", "v"};
  shader.text +=
      "\n// Radiance towards v at a point with normal n, tangent t and s at right angles to both.\n";
  shader.text += l.function(
      ValueType::vector, fmt::format("burnish_{}_light", name), kParameters, "",
      fmt::format("  if (dot(n, v) <= {0}) {{ return {1}({0}, {0}, {0}); }}\n", l.literal(0), l.vector) +
          writer.text() + fmt::format(fmt::runtime(l.result), writer.text(root)));
  return shader;
}

}  // namespace burnish
