// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/lookup_expression.h>
#include <burnish/formula/writer.h>
#include <burnish/shaders/frame_function.h>
#include <burnish/shaders/half_range.h>
#include <burnish/shaders/shader_formula.h>
#include <burnish/shaders/texture_declaration.h>
#include <burnish/shaders/texture_packing.h>

namespace burnish {

namespace {

// Writes table lookups as expressions that read textures.
class Lookups {
 public:
  Lookups(const FactoredBrdf& brdf, const std::vector<ShaderTexture>& textures, ShaderFilter filter)
      : brdf_(brdf), filter_(filter), places_(brdf.tables().size()) {
    for (const ShaderTexture& texture : textures)
      for (const PlacedTable& placed : texture.tables) places_[placed.table] = {&texture, placed.first};
  }

  /// Returns the table's value for a use.
  Expr value(const FactorUse& use) const {
    const TableLayout& layout = brdf_.table_of(use).layout;
    const Place& place = places_[use.table];
    const ValueType type = brdf_.table_of(use).channels == 1 ? ValueType::real : ValueType::vector;
    return filter_ == ShaderFilter::hardware ? filtered(layout, use, place, type)
                                             : weighed(layout, use, place, type);
  }

 private:
  struct Place {
    const ShaderTexture* texture = nullptr;
    std::array<int, 3> first{};
  };

  static Expr filtered(const TableLayout& layout, const FactorUse& use, const Place& place, ValueType type) {
    // The hardware filters: positions run from the middle of the first node's texel to that of the last one.
    const auto& [texture, first] = place;
    const auto axis = [](int nodes, double texel, int texels) {
      return TableAxis{(nodes - 1.0) / texels, (texel + 0.5) / texels};
    };
    const auto [x, y, z] = position_expressions(layout, use, axis(layout.width, first[0], texture->width),
                                                axis(layout.height, first[1], texture->height),
                                                axis(layout.depth, first[2], std::max(texture->depth, 1)));
    std::vector<Expr> at{x};
    // A 2-D texture that holds lines needs the middle of the line's row as second coordinate.
    if (texture->height > 0)
      at.push_back(axis_count(layout.shape) == 1 ? Expr((first[1] + 0.5) / texture->height) : y);
    if (texture->depth > 0) at.push_back(z);
    return named("value", Expr::sample(texture->name, at, type));
  }

  // The two texels around a position along an axis, and the fraction from the lower one.
  struct Cell {
    Expr low, high, fraction;
  };
  static Cell cell_of(const Expr& position, int nodes, int first) {
    if (nodes == 1) return {Expr::integer(first), Expr::integer(first), 0.0};
    const CellExpr cell = cell_expression(position, nodes);
    const Expr node = named("i", Expr(Op::to_integer, {cell.node}));
    return {node + Expr::integer(first), node + Expr::integer(first + 1), cell.fraction};
  }

  static Expr weighed(const TableLayout& layout, const FactorUse& use, const Place& place, ValueType type) {
    const ShaderTexture* const texture = place.texture;  // clang 14 cannot capture a binding
    const auto& first = place.first;
    // The shader interpolates: positions are in cells, and texels are read around them.
    const auto axis = [](int nodes) { return TableAxis{nodes - 1.0, 0}; };
    const auto [x, y, z] =
        position_expressions(layout, use, axis(layout.width), axis(layout.height), axis(layout.depth));
    const Cell across = cell_of(x, layout.width, first[0]), up = cell_of(y, layout.height, first[1]),
               behind = cell_of(z, layout.depth, first[2]);
    // An array (cpp) has a volume's layers one after another.
    const auto texel = [&](const Expr& column, const Expr& row, const Expr& layer) {
      std::vector<Expr> at{column, row};
      if (texture->depth > 0)
        at.push_back(layer);
      else if (layout.depth > 1)
        at[1] = layer * Expr::integer(layout.height) + row;
      return named("texel", Expr::texel(texture->name, at, type));
    };
    // Interpolation is linear along each axis: in a row, between rows, between layers.
    const auto in_row = [&](const Expr& row, const Expr& layer) {
      return mix_expression(texel(across.low, row, layer), texel(across.high, row, layer), across.fraction);
    };
    const auto in_layer = [&](const Expr& layer) {
      const Expr low = in_row(up.low, layer);
      return layout.height == 1 ? low : mix_expression(low, in_row(up.high, layer), up.fraction);
    };
    const Expr low = in_layer(behind.low);
    return layout.depth == 1 ? low : mix_expression(low, in_layer(behind.high), behind.fraction);
  }

  const FactoredBrdf& brdf_;
  ShaderFilter filter_;
  std::vector<Place> places_;
};

// Returns by table the powers of 2 that tables are multiplied with in textures.
std::vector<int> exponents_in(const std::vector<ShaderTexture>& textures, std::size_t tables) {
  std::vector<int> exponents(tables, 0);
  for (const ShaderTexture& texture : textures)
    for (const PlacedTable& placed : texture.tables) exponents[placed.table] = placed.exponent;
  return exponents;
}

Expr scale_value(const Lobe& lobe, int exponent) {
  std::vector<Expr> scale;
  for (const double s : lobe.scale) scale.emplace_back(std::ldexp(s, exponent));
  return scale.size() == 1 ? scale[0] : Expr(Op::vector, scale);
}

// Returns a lobe's value: scale times lookups [HomomorphicBrdf, eq. 4], where the two values of a pair are multiplied
// first, as in the definition. Textures hold their tables times 2^exponents, which the scale divides out.
Expr lobe_value(const Lookups& lookups, const FactoredBrdf& brdf, std::size_t j,
                const std::vector<int>& exponents, bool half_products) {
  const auto uses = brdf.ordered_factors(j);
  int in_tables = 0;
  for (const FactorUse& use : uses) in_tables += exponents[use.table];
  if (half_products) {
    // In half precision, the order of the factors and constants between them keep products within the range of
    // halves.
    const HalfProduct half = half_product(brdf, j, exponents);
    const auto constants = static_cast<int>(std::ranges::count(half.order, HalfProduct::kConstant));
    Expr product = scale_value(brdf.lobes()[j], -in_tables - constants * half.exponent);
    // This order keeps products within half floats; each constant 2^exponent in it is taken out of the scale.
    for (const int k : half.order)
      product = product * (k == HalfProduct::kConstant ? Expr(std::ldexp(1.0, half.exponent))
                                                       : lookups.value(uses[static_cast<std::size_t>(k)]));
    return named("lobe", product);
  }
  // In single precision, pairs come first and the other factors follow.
  const std::size_t paired = 2 * brdf.pair_count(j);
  Expr product = scale_value(brdf.lobes()[j], -in_tables);
  for (std::size_t k = 0; k < uses.size(); k += k < paired ? 2 : 1) {
    // A pair's two values are multiplied first, then the product takes them.
    const Expr value = lookups.value(uses[k]);
    product = product * (k < paired ? value * lookups.value(uses[k + 1]) : value);
  }
  return named("lobe", product);
}

std::vector<Expr> lobe_values(const FactoredBrdf& brdf, const std::vector<ShaderTexture>& textures,
                              const ShaderOptions& options) {
  const Lookups lookups(brdf, textures, options.filter);
  const std::vector<int> exponents = exponents_in(textures, brdf.tables().size());
  std::vector<Expr> lobes;
  for (std::size_t j = 0; j < brdf.lobes().size(); ++j)
    lobes.push_back(lobe_value(lookups, brdf, j, exponents, options.half_products));
  return lobes;
}

// Returns an array and a function that reads it, as C++ has no textures.
std::string declare_array(const Language& l, const ShaderTexture& texture) {
  std::string text = fmt::format("BURNISH_CONSTANT float {}[] = {{", texture.name);
  for (std::size_t k = 0; k < texture.values.size(); ++k)
    text += fmt::format("{}{},", k % 8 ? " " : "\n    ", l.literal(texture.values[k]));
  text += "\n};\n";
  const std::string at = fmt::format("{}[{} * (y * {} + x)", texture.name, texture.channels, texture.width);
  if (texture.channels == 1)
    return text +
           fmt::format("BURNISH_FUNCTION float {}_at(int x, int y) {{ return {}]; }}\n", texture.name, at);
  return text + fmt::format(
                    "BURNISH_FUNCTION vec3 {0}_at(int x, int y) {{\n"
                    "  return {{{1}], {1} + 1], {1} + 2]}};\n}}\n",
                    texture.name, at);
}

// Returns functions that read a picture of layers. A position stays within the middles of the outermost texels, so
// that no layer mixes with another.
std::string layer_functions(const ShaderTexture& texture, ShaderFilter filter) {
  if (filter == ShaderFilter::exact)
    return fmt::format(
        "vec4 {0}_texel(sampler2D layers, ivec3 at) {{\n"
        "  return texelFetch(layers, ivec2(at.x, at.z * {1} + at.y), 0);\n}}\n",
        texture.name, texture.height);
  return fmt::format(
      "vec4 {0}_between(sampler2D layers, vec3 at) {{\n"
      "  float z = at.z * {1:d}.0 - 0.5, low = clamp(floor(z), 0.0, {2:d}.0);\n"
      "  vec4 below = textureLod(layers, vec2(at.x, (low + at.y) / {1:d}.0), 0.0);\n"
      "  vec4 above = textureLod(layers, vec2(at.x, (low + 1.0 + at.y) / {1:d}.0), 0.0);\n"
      "  return mix(below, above, clamp(z - low, 0.0, 1.0));\n}}\n",
      texture.name, texture.depth, std::max(texture.depth - 2, 0));
}

std::string declare_textures(const Language& l, const ShaderOptions& options,
                             const std::vector<ShaderTexture>& textures) {
  std::string text;
  if (options.textures_are_arguments) {
    for (const ShaderTexture& texture : textures)
      if (texture.depth > 0) text += layer_functions(texture, options.filter);
    return text;
  }
  // A texture's declaration depends on its dimensions and on who filters.
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const ShaderTexture& texture = textures[i];
    const bool filtered = options.filter == ShaderFilter::hardware;
    const std::string_view pattern = texture.height == 0 ? l.texture_1d
                                     : texture.depth > 0 ? filtered ? l.filtered_texture_3d : l.texture_3d
                                     : filtered          ? l.filtered_texture
                                                         : l.texture;
    text += l.texture.empty() ? declare_array(l, texture)
                              : declared_texture(l, pattern, texture.name, i, options);
  }
  if (l.texture_struct.empty()) return text;
  return fmt::format(fmt::runtime(l.texture_struct), "burnish_" + options.name + "_tables", text);
}

ShaderCost cost_of(const OperationCount& count, std::size_t textures) noexcept {
  return {.fetches = count.fetches,
          .textures = static_cast<int>(textures),
          .operations = count.multiplies + count.adds + count.compares,
          .divisions = count.divisions,
          .roots = count.roots,
          .powers = count.transcendentals};
}

// Returns the parameters of functions besides the directions.
MoreParameters more_of(const ShaderOptions& options, const std::vector<ShaderTexture>& textures) {
  if (options.language == ShaderLanguage::msl)
    return {fmt::format("burnish_{}_tables tables", options.name), "tables"};
  MoreParameters more;
  if (!options.textures_are_arguments) return more;
  for (const ShaderTexture& texture : textures) {
    const char* const comma = more.names.empty() ? "" : ", ";
    more.declarations += fmt::format("{}sampler2D {}", comma, texture.name);
    more.names += comma + texture.name;
  }
  return more;
}

// Returns the language. Where textures are arguments, a picture has the layers of a 3-D texture, and functions read
// it.
Language language_of(const ShaderOptions& options) {
  Language l = language(to_string(options.language));
  if (!options.textures_are_arguments) return l;
  l.sample_3d = "{0}_between({0}, vec3({1}, {2}, {3})).{4}";
  l.texel_3d = "{0}_texel({0}, ivec3({1}, {2}, {3})).{4}";
  return l;
}

struct LocalFunction {
  std::string text;
  OperationCount count;
};
LocalFunction local_function(Expr total, const Language& l, const ShaderOptions& options,
                             const std::string& name, const MoreParameters& more) {
  // Grey models give three equal channels.
  if (total.type() == ValueType::real) {
    total = named("f0", total);
    total = Expr(Op::vector, {total, total, total});
  }
  // The graph shares equal expressions; the writer turns it into statements, and the graph counts their cost.
  Graph graph;
  const std::size_t root = graph.add(total);
  const Writer writer(l, graph, {root}, options.half_products);
  std::string body = horizon_test(l);
  if (options.language == ShaderLanguage::msl && options.filter == ShaderFilter::hardware)
    body += "  constexpr sampler smooth_sampler(filter::linear, address::clamp_to_edge);\n";
  const std::string value =
      options.half_products ? fmt::format("{}({})", l.vector, writer.text(root)) : writer.text(root);
  body += writer.text() + fmt::format(fmt::runtime(l.result), value);
  return {l.function(ValueType::vector, name, kTwoDirections, more.declarations, body), graph.count()};
}

std::string_view header_of(const Language& l, const ShaderOptions& options) noexcept {
  return options.half_products && !options.appended ? l.half_header : l.header;
}

void check(const FactoredBrdf& brdf, const ShaderOptions& options) {
  const bool cpp = options.language == ShaderLanguage::cpp;
  check_shader_name(options.name);
  if (brdf.channels() != 1 && brdf.channels() != 3)
    throw Error(fmt::format("shader: expected a model of 1 or 3 channels, found {}", brdf.channels()));
  if (cpp && options.filter == ShaderFilter::hardware)
    throw Error("shader: expected the exact filter for cpp, which has no texture units, found hardware");
  if (options.lines_are_1d &&
      (options.language != ShaderLanguage::glsl || options.filter != ShaderFilter::hardware))
    throw Error("shader: expected glsl and the hardware filter with 1-D textures, found others");
  if (options.textures_are_arguments && (options.language != ShaderLanguage::glsl || options.lines_are_1d))
    throw Error("shader: expected glsl without 1-D textures where textures are arguments, found others");
  check_places(options.places);
  if (options.half_products && options.filter == ShaderFilter::exact)
    throw Error("shader: expected the hardware filter with half products, found exact");
}

}  // namespace

std::string_view to_string(ShaderLanguage language) noexcept {
  constexpr std::string_view kNames[] = {"glsl", "glsl_es", "hlsl", "msl", "slang", "wgsl", "cpp"};
  return kNames[static_cast<std::size_t>(language)];
}

std::string to_string(const ShaderCost& cost) {
  const std::string fetches = cost.fetches == 0 ? "0 fetches"
                                                : fmt::format("{} fetches of {} texture{}", cost.fetches,
                                                              cost.textures, cost.textures == 1 ? "" : "s");
  return fmt::format("{}, {} operations, {} divisions, {} roots, {} powers", fetches, cost.operations,
                     cost.divisions, cost.roots, cost.powers);
}

ShaderFormula shader_formula(const FactoredBrdf& brdf, const ShaderOptions& options,
                             const LayersBefore* before) {
  check(brdf, options);
  ShaderFormula formula;
  formula.textures = options.language == ShaderLanguage::cpp ? tables_apart(brdf, options.name)
                                                             : pack_tables(brdf, options.name, before);
  for (ShaderTexture& texture : formula.textures)
    if (options.lines_are_1d && texture.height == 1 && texture.depth == 0) texture.height = 0;
  // The model is the sum of its lobes [HomomorphicBrdf, eq. 4].
  formula.lobes = lobe_values(brdf, formula.textures, options);
  for (const Expr& lobe : formula.lobes) formula.value = formula.value + lobe;
  return formula;
}

LobeFunctions lobe_functions(const FactoredBrdf& brdf, const ShaderOptions& options,
                             const LayersBefore* before) {
  ShaderFormula formula = shader_formula(brdf, options, before);
  const Language l = language_of(options);
  LobeFunctions functions{.text = std::string(header_of(l, options)), .names = {}, .textures = {}};
  functions.textures = std::move(formula.textures);
  functions.text += declare_textures(l, options, functions.textures);
  const MoreParameters more = more_of(options, functions.textures);
  for (std::size_t j = 0; j < formula.lobes.size(); ++j) {
    functions.names.push_back(fmt::format("burnish_{}_lobe{}", options.name, j));
    functions.text += local_function(formula.lobes[j], l, options, functions.names.back(), more).text;
  }
  return functions;
}

Shader generate_shader(const FactoredBrdf& brdf, const ShaderOptions& options) {
  ShaderFormula formula = shader_formula(brdf, options);
  const Language l = language_of(options);
  const bool cpp = options.language == ShaderLanguage::cpp;
  Shader shader;
  shader.textures = std::move(formula.textures);
  const MoreParameters more = more_of(options, shader.textures);
  const LocalFunction function = local_function(formula.value, l, options, "burnish_" + options.name, more);
  shader.cost = cost_of(function.count, shader.textures.size());
  // A table's name may hold characters that a comment may not.
  const auto comment_of = [](std::string text) {
    for (char& c : text) c = c < ' ' || c > '~' || c == '\\' ? '?' : c;
    return text;
  };
  shader.text = fmt::format(
      "// Generated by burnish from the model {}: change the model, not this file.\n"
      "// burnish_{}(wi, wo): f_r in 1/sr, without the cosine; unit vectors of the local frame, +z the "
      "normal.\n"
      "// {}.\n{}",
      comment_of(model_expression(brdf)), options.name, to_string(shader.cost), header_of(l, options));
  if (cpp) shader.text += "namespace burnish_shader {\n";
  shader.text += declare_textures(l, options, shader.textures);
  shader.text += function.text + world_function(l, options.name, more);
  if (cpp) shader.text += "}  // namespace burnish_shader\n";
  return shader;
}

FormulaSurroundings formula_surroundings(const ShaderOptions& options,
                                         const std::vector<ShaderTexture>& textures) {
  const Language l = language_of(options);
  return {std::string(header_of(l, options)) + declare_textures(l, options, textures),
          more_of(options, textures)};
}

FormulaFunction formula_function(const Expr& value, const ShaderOptions& options, const std::string& name,
                                 const MoreParameters& more, std::size_t textures) {
  const LocalFunction function = local_function(value, language_of(options), options, name, more);
  return {function.text, cost_of(function.count, textures)};
}

SplitShader split_shader(const FactoredBrdf& brdf, const ShaderOptions& options) {
  return split_formula(shader_formula(brdf, options), options);
}

SplitShader split_formula(ShaderFormula formula, const ShaderOptions& options) {
  if (options.language != ShaderLanguage::glsl && options.language != ShaderLanguage::glsl_es)
    throw Error(
        fmt::format("shader: expected glsl or glsl_es to split, found {}", to_string(options.language)));
  if (options.textures_are_arguments) throw Error("shader: expected textures that are uniforms to split");
  const Language& l = language(to_string(options.language));
  SplitShader shader;
  shader.textures = std::move(formula.textures);
  shader.declarations = std::string(header_of(l, options)) + declare_textures(l, options, shader.textures);
  Graph graph;
  const std::size_t root = graph.add(formula.value);
  const Writer writer(l, graph, {root}, options.half_products);
  OperationCount view, rest;
  // Statements that depend on wi are computed for each light, all others once for each view.
  for (const Statement& statement : writer.statements()) {
    const bool lit = graph.reaches(statement.node, "wi");
    (lit ? shader.light : shader.view) += statement.text;
    (lit ? rest : view) += statement.count;
  }
  rest += writer.count(root);
  shader.value = fmt::format("{}({})", l.vector, writer.text(root));
  shader.view_cost = cost_of(view, shader.textures.size());
  shader.light_cost = cost_of(rest, shader.textures.size());
  return shader;
}

}  // namespace burnish
