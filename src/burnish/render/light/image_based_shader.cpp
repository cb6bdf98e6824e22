// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/lookup_expression.h>
#include <burnish/formula/writer.h>
#include <burnish/render/gl/gl_evaluator.h>
#include <burnish/render/light/image_based_light.h>
#include <burnish/render/light/lobe_parts.h>
#include <burnish/render/light/map_expression.h>
#include <burnish/render/light/prefiltered_formula.h>
#include <burnish/shaders/shader_formula.h>
#include <burnish/shaders/texture_declaration.h>

namespace burnish {

namespace {

Expr length(const ExprVector& v) {
  return sqrt(dot(v, v));
}

// The view of a pair of normal and view, as far as all lobes share it.
struct View {
  ExprVector n, plane, wo;
  Expr slice, low, part;  // position among the slices, the one below it, how far from it

  explicit View(int slices) : n(Expr::input("n", ValueType::vector)), plane(n), wo(n) {
    const ExprVector v(Expr::input("v", ValueType::vector));
    const Expr cosine = named("cos_o", min(dot(n, v), 1.0));
    const ExprVector away = named("away", cosine * n - v);
    const Expr sine = named("sin_o", length(away));
    plane = named("plane", Expr(1.0) / max(sine, kMinSine) * away);
    wo = named("wo", ExprVector(-sine, 0.0, cosine));
    slice = named("slice", sine / (1 + cosine) * (slices - 1));
    low = named("low", min(Expr(Op::to_integer, {slice}), Expr::integer(slices - 2)));
    part = named("part", slice - Expr(Op::to_real, {low}));
  }
};

// The radiance through one lobe's maps, which begin at slice `first` of `depth`.
Expr seen(const ImageBasedLight& light, const View& view, const std::string& axes, const std::string& maps,
          int first, int depth) {
  const auto& [slices, side, orders] = light.options;
  // the kernel's axis in the world, and the tilt that its azimuth counts from
  const auto entry = [&](const Expr& index) { return Expr::element(axes, index, ValueType::real); };
  const Expr angle =
      named("angle", mix_expression(entry(view.low), entry(view.low + Expr::integer(1)), view.part));
  const auto [axis_world, tilt_world] = kernel_axis(view.n, view.plane, angle);
  const ExprVector shown = named("axis", axis_world);

  // its place in the maps of its half, and the azimuth of the tilt there
  const ExprVector axis = in_half_of(shown, shown), tilt = in_half_of(shown, named("tilt", tilt_world));
  const TurnedAxes<ExprVector> across(axis);
  const auto weights =
      harmonics<kMaxMaps>(named("turn_x", dot(tilt, across.x)), named("turn_y", dot(tilt, across.z)));
  const auto [place_x, place_y] = map_coordinates(shown, side);

  // every map, weighed by its harmonic
  Expr sum;
  for (int map = 0; map < 2 * orders + 1; ++map) {
    const Expr place_z = (view.slice + (first + map * slices + 0.5)) * (1.0 / depth);
    const Expr value = Expr::sample(maps, {place_x, place_y, place_z}, ValueType::vector);
    sum = sum + weights[static_cast<std::size_t>(map)] * named("map", value);
  }
  return named("seen", sum);
}

}  // namespace

ImageBasedShader generate_shader(const ImageBasedLight& light, ShaderLanguage language,
                                 const std::string& name) {
  const Language& l = burnish::language(to_string(language));
  if (language != ShaderLanguage::glsl && language != ShaderLanguage::glsl_es)
    throw Error(fmt::format("image-based light: expected glsl or glsl_es, found {}", l.name));
  // all lobes' maps are slices of one texture
  const int slices_a_lobe = light.map_count() * light.options.slices;
  const int depth = static_cast<int>(light.lobes.size()) * slices_a_lobe;
  ImageBasedShader shader{.maps = fmt::format("burnish_{}_maps", name)};
  std::vector<FactoredBrdf> parts;
  for (const PrefilteredLobe& lobe : light.lobes) parts.push_back(lobe.outside);
  LobeFunctions factors = lobe_functions(
      joined(parts), {.language = language, .filter = ShaderFilter::hardware, .name = name + "_view"});
  shader.text =
      factors.text + declared_texture(l, l.filtered_texture_3d, shader.maps, 0, {.language = language});
  shader.tables = std::move(factors.textures);

  // every lobe: the factors of the view times what its maps show
  const View view(light.options.slices);
  Expr sum;
  for (std::size_t j = 0; j < light.lobes.size(); ++j) {
    const PrefilteredLobe& lobe = light.lobes[j];
    const std::string axes = fmt::format("burnish_{}_axes{}", name, j);
    shader.text += l.declare_array(axes, lobe.axis);
    const Expr wo = view.wo.whole();
    sum = sum + Expr::call(factors.names[j], {wo, wo}, ValueType::vector) *
                    seen(light, view, axes, shader.maps, static_cast<int>(j) * slices_a_lobe, depth);
  }
  const Expr dark(Op::vector, {0.0, 0.0, 0.0});
  Graph graph;
  const std::size_t root = graph.add(max(sum, dark));
  const Writer writer(l, graph, {root});
  constexpr std::array<std::string_view, 2> kParameters{"n", "v"};
  shader.text += "\n// Radiance towards v at normal n, of the light that the maps were made from.\n";
  shader.text += l.function(
      ValueType::vector, fmt::format("burnish_{}_light", name), kParameters, "",
      fmt::format("  if (dot(n, v) <= {0}) {{ return {1}({0}, {0}, {0}); }}\n", l.literal(0), l.vector) +
          writer.text() + fmt::format(fmt::runtime(l.result), writer.text(root)));
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
