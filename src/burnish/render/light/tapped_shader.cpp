// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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
#include <burnish/shaders/texture_declaration.h>
#include <burnish/shaders/texture_packing.h>

namespace burnish {

namespace {

// The texture of the environment: its levels, with volumes behind them where the tables have any.
ShaderTexture environment_texture(const BlurredEnvironment& blurred, LayersBefore levels,
                                  std::vector<ShaderTexture>& tables) {
  const auto shared = std::ranges::find(tables, levels.name, &ShaderTexture::name);
  if (shared == tables.end())
    return {.name = std::move(levels.name),
            .width = levels.width,
            .height = levels.height,
            .depth = levels.depth,
            .channels = levels.channels,
            .format = TableFormat::single,
            .values = blurred.maps,
            .tables = {}};
  // texels beyond the maps repeat their edges
  ShaderTexture texture = std::move(*shared);
  tables.erase(shared);
  texture.format = TableFormat::single;
  const std::size_t channels = levels.channels;
  for (int z = 0; z <= levels.depth; ++z)
    for (int y = 0; y < texture.height; ++y)
      for (int x = 0; x < texture.width; ++x) {
        const int layer = std::min(z, levels.depth - 1), row = std::min(y, levels.height - 1);
        const auto from = static_cast<std::size_t>((layer * levels.height + row) * levels.width +
                                                   std::min(x, levels.width - 1)) *
                          channels,
                   to = static_cast<std::size_t>((z * texture.height + y) * texture.width + x) * channels;
        std::copy_n(&blurred.maps[from], channels, &texture.values[to]);
      }
  return texture;
}

// The environment at a direction of the world, blurred as wide as the level tells.
std::string blurred_function(const Language& l, const ShaderTexture& texture, const BlurOptions& blur) {
  const ExprVector w(Expr::input("w", ValueType::vector));
  const auto [x, y] = map_coordinates(w, blur.side);
  // of the part of the texture that the maps take
  const auto within = [](const Expr& at, int maps, int texels) {
    return maps == texels ? at : at * (static_cast<double>(maps) / texels);
  };
  const Expr level = min(max(Expr::input("level"), 0.0), blur.levels - 1.0);
  Graph graph;
  const std::size_t root =
      graph.add(Expr::sample(texture.name,
                             {within(x, 2 * blur.side, texture.width), within(y, blur.side, texture.height),
                              (level + 0.5) * (1.0 / texture.depth)},
                             ValueType::vector));
  const Writer writer(l, graph, {root});
  constexpr std::array<std::string_view, 1> kParameters{"w"};
  return l.function(ValueType::vector, texture.name + "_at", kParameters,
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

TappedShader generate_shader(const TappedBrdf& brdf, const BlurredEnvironment& environment,
                             ShaderLanguage language, const std::string& name) {
  const Language& l = burnish::language(to_string(language));
  if (language != ShaderLanguage::glsl && language != ShaderLanguage::glsl_es)
    throw Error(fmt::format("tapped light: expected glsl or glsl_es, found {}", l.name));
  // the lobes' functions, their volumes behind the environment's levels
  const BlurOptions& blur = environment.options;
  const LayersBefore levels{fmt::format("burnish_{}_environment", name), 2 * blur.side, blur.side,
                            blur.levels, 3};
  TappedShader shader;
  std::vector<FactoredBrdf> parts;  // outside and inside of each lobe
  for (const TappedLobe& lobe : brdf.lobes) parts.insert(parts.end(), {lobe.outside, lobe.inside});
  LobeFunctions factors = lobe_functions(
      joined(parts), {.language = language, .filter = ShaderFilter::hardware, .name = name + "_factors"},
      &levels);
  shader.textures = std::move(factors.textures);
  ShaderTexture around = environment_texture(environment, levels, shader.textures);
  const bool declared_with_volumes = !around.tables.empty();
  shader.textures.insert(shader.textures.begin(), std::move(around));
  shader.text = factors.text;
  if (!declared_with_volumes)
    shader.text += declared_texture(l, l.filtered_texture_3d, levels.name, 0, {.language = language});
  shader.text += blurred_function(l, shader.textures.front(), blur);

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
        gathered_function(l, brdf.lobes[j], name_of_lobe, factors.names[2 * j + 1], levels.name, blur);
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
