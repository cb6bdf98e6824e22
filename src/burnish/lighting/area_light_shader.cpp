// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/formula/writer.h>
#include <burnish/lighting/area_light_shader.h>
#include <burnish/lighting/rectangle_formula.h>
#include <burnish/shaders/frame_function.h>
#include <burnish/shaders/texture_declaration.h>

namespace burnish {

namespace {

constexpr int kTextureNumber = 8;

// Returns the number of texture rows of a lobe, for its matrix and height. The plain cosine's height comes first in
// the texture.
int rows_a_lobe(const AreaLightTable& table) noexcept {
  return table.views == AreaLightViews::line ? 3 : 4;
}

ShaderTexture area_texture(const AreaLightTable& table, const std::string& name) {
  ShaderTexture texture;
  texture.name = name;
  texture.width = static_cast<int>(table.thetas);
  texture.height = static_cast<int>(table.azimuths *
                                    (1 + table.lobes.size() * static_cast<std::size_t>(rows_a_lobe(table))));
  texture.channels = 3;
  texture.format = TableFormat::half;
  // [quantity][azimuth][theta][channel]
  const auto add = [&](std::span<const float> values, std::size_t each, std::array<std::size_t, 3> entries) {
    for (std::size_t node = 0; node < table.nodes(); ++node)
      for (const std::size_t k : entries) texture.values.push_back(k < each ? values[node * each + k] : 0.0F);
  };
  constexpr std::size_t kNone = 9;
  add(table.cosine, 3, {0, 1, 2});
  for (const AreaLobe& lobe : table.lobes) {
    if (table.views == AreaLightViews::line) {
      add(lobe.inverse, 9, {0, 2, 4});
      add(lobe.inverse, 9, {6, 8, kNone});
    } else {
      for (const std::size_t row : {0u, 3u, 6u}) add(lobe.inverse, 9, {row, row + 1, row + 2});
    }
    add(lobe.amplitude, 3, {0, 1, 2});
  }
  return texture;
}

// Finds the texture coordinates of a view's node, and the frame of its mirrored view.
class ShaderView {
 public:
  ShaderView(const AreaLightTable& table, const ShaderTexture& texture)
      : table_(table), texture_(texture), x_(wo_), y_(wo_) {
    const Expr sine = named("sin_o", sqrt(max(wo_.x * wo_.x + wo_.y * wo_.y, 0.0)));
    const Expr over = named("over", Expr(1.0) / max(sine, 1e-6)), normal = Expr(1e-6);
    // At the normal x is the tangent.
    const Expr cx = named("cos_phi", if_less(sine, normal, 1.0, wo_.x * over));
    const Expr cy = named("sin_phi", if_less(sine, normal, 0.0, wo_.y * over));
    const Expr side =
        table.views == AreaLightViews::quarter ? if_less(wo_.x * wo_.y, 0.0, -1.0, 1.0) : Expr(1.0);
    x_ = named("axis_x", ExprVector(wo_.z * cx, wo_.z * cy, sine));
    y_ = named("axis_y", ExprVector(-(side * cy), side * cx, 0.0));
    const auto width = static_cast<double>(table.thetas);
    u_ = named("u", min(sine / (1.0 + wo_.z), 1.0) * ((width - 1) / width) + 0.5 / width);
    azimuth_ = named("azimuth", azimuth());
  }

  // Reads three numbers of a quantity.
  ExprVector read(int quantity, const char* called) const {
    const auto azimuths = static_cast<double>(table_.azimuths);
    const double height = texture_.height;
    const Expr v = azimuth_ * ((azimuths - 1) / height) + (quantity * azimuths + 0.5) / height;
    return ExprVector(named(called, Expr::sample(texture_.name, {u_, v}, ValueType::vector)));
  }
  // Turns a vector of the local frame into the frame of the mirrored view.
  ExprVector in_frame(const ExprVector& w) const { return {dot(x_, w), dot(y_, w), dot(mirror(wo_), w)}; }

 private:
  Expr azimuth() const {
    if (table_.views == AreaLightViews::line) return 0.0;
    const Expr size = max(abs(wo_.x) + abs(wo_.y), 1e-6), quarter = named("quarter", abs(wo_.y) / size);
    if (table_.views == AreaLightViews::quarter) return quarter;
    const Expr front = if_less(wo_.x, 0.0, 2.0 - quarter, quarter),
               back = if_less(wo_.x, 0.0, 2.0 + quarter, 4.0 - quarter);
    return 0.25 * if_less(wo_.y, 0.0, back, front);
  }

  const AreaLightTable& table_;
  const ShaderTexture& texture_;
  ExprVector wo_{Expr::input("wo", ValueType::vector)}, x_, y_;
  Expr u_, azimuth_;
};

Expr reflected_by_quad(const AreaLightTable& table, const ShaderTexture& texture) {
  const ShaderView view(table, texture);
  std::array<ExprVector, 4> corners{ExprVector(0.0, 0.0, 1.0), ExprVector(0.0, 0.0, 1.0),
                                    ExprVector(0.0, 0.0, 1.0), ExprVector(0.0, 0.0, 1.0)};
  for (std::size_t i = 0; i < 4; ++i)
    corners[i] = ExprVector(Expr::input(fmt::format("p{}", i), ValueType::vector));
  const LitQuad<ExprVector> quad(corners);
  Expr sum = named("share", quad.cosine_share()) * view.read(0, "height").whole();
  for (std::size_t j = 0; j < table.lobes.size(); ++j) {
    const int first = 1 + static_cast<int>(j) * rows_a_lobe(table);
    const bool line = table.views == AreaLightViews::line;
    const ExprVector a = view.read(first, "row"), b = view.read(first + 1, "row"),
                     c = line ? b : view.read(first + 2, "row"),
                     height = view.read(first + rows_a_lobe(table) - 1, "height");
    const auto to_cosine = [&](const ExprVector& w) {
      const ExprVector f = view.in_frame(w);
      if (line) return ExprVector(a.x * f.x + a.y * f.z, a.z * f.y, b.x * f.x + b.y * f.z);
      return ExprVector(dot(a, f), dot(b, f), dot(c, f));
    };
    sum = sum + named("share", quad.lobe_share(to_cosine)) * height.whole();
  }
  return sum;
}

}  // namespace

AreaLightShader generate_shader(const AreaLightTable& table, ShaderLanguage language, const std::string& name,
                                const ShaderPlaces& places) {
  check_shader_name(name);
  check_places(places);
  if (language == ShaderLanguage::cpp)
    throw Error("area lights: expected a language with textures, found cpp");
  const Language& l = burnish::language(to_string(language));
  const bool msl = language == ShaderLanguage::msl;
  AreaLightShader shader;
  shader.texture = area_texture(table, fmt::format("burnish_{}_area", name));

  Graph graph;
  const std::size_t root = graph.add(reflected_by_quad(table, shader.texture));
  const Writer writer(l, graph, {root});
  const OperationCount count = graph.count();
  shader.cost = {.fetches = count.fetches,
                 .textures = 1,
                 .operations = count.multiplies + count.adds + count.compares,
                 .divisions = count.divisions,
                 .roots = count.roots,
                 .powers = count.transcendentals};

  const std::string declared = declared_texture(l, l.filtered_texture, shader.texture.name, kTextureNumber,
                                                {.language = language, .places = places});
  const std::string tables = fmt::format("burnish_{}_area_tables", name);
  shader.text = fmt::format(
      "// Generated by burnish: change the model, not this file.\n"
      "// burnish_{0}_quad(wo, p0, p1, p2, p3): radiance reflected towards wo of a quadrilateral of radiance "
      "1; corners in\n"
      "// order, relative to the point that is lit; vectors of the local frame, +z the normal.\n"
      "// burnish_{0}_quad_world(n, t, v, p0, p1, p2, p3): the same in any frame.\n"
      "// {1}.\n{2}{3}",
      name, to_string(shader.cost), l.header,
      l.texture_struct.empty() ? declared : fmt::format(fmt::runtime(l.texture_struct), tables, declared));

  const std::string more = msl ? tables + " tables" : "", more_name = msl ? ", tables" : "";
  std::string body =
      fmt::format("  if (wo.z <= {0}) {{ return {1}({0}, {0}, {0}); }}\n", l.literal(0), l.vector);
  if (msl) body += "  constexpr sampler smooth_sampler(filter::linear, address::clamp_to_edge);\n";
  constexpr std::array<std::string_view, 5> kLocal{"wo", "p0", "p1", "p2", "p3"};
  shader.text += l.function(ValueType::vector, fmt::format("burnish_{}_quad", name), kLocal, more,
                            body + writer.text() + fmt::format(fmt::runtime(l.result), writer.text(root)));

  constexpr std::array<std::string_view, 7> kWorld{"n", "t", "v", "p0", "p1", "p2", "p3"};
  std::string arguments;
  for (const std::string_view w : {"v", "p0", "p1", "p2", "p3"})
    arguments += fmt::format("{0}{1}(dot(t, {2}), dot(s, {2}), dot(n, {2}))", arguments.empty() ? "" : ", ",
                             l.vector, w);
  shader.text += l.function(ValueType::vector, fmt::format("burnish_{}_quad_world", name), kWorld, more,
                            l.declaration(ValueType::vector, "s", "cross(n, t)") +
                                fmt::format(fmt::runtime(l.result), fmt::format("burnish_{}_quad({}{})", name,
                                                                                arguments, more_name)));
  return shader;
}

}  // namespace burnish
