#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/lookup_expression.h>
#include <burnish/formula/writer.h>
#include <burnish/shaders/frame_function.h>
#include <burnish/shaders/shader_formula.h>

namespace burnish {

namespace {

TableAxis axis_of(int nodes, ShaderFilter filter) noexcept {
  if (filter == ShaderFilter::exact) return {nodes - 1.0, 0};
  return {(nodes - 1.0) / nodes, 0.5 / nodes};
}

class Lookups {
 public:
  Lookups(const FactoredBrdf& brdf, const std::vector<ShaderTexture>& textures, const ShaderOptions& options)
      : brdf_(brdf), filter_(options.filter), places_(brdf.tables().size()) {
    for (const ShaderTexture& texture : textures)
      for (std::size_t k = 0; k < texture.tables.size(); ++k)
        places_[texture.tables[k]] = {&texture, texture.first_rows[k]};
  }

  /// The table's value.
  Expr value(const FactorUse& use) const {
    const auto index = static_cast<std::size_t>(use.table);
    const Table& table = brdf_.tables()[index];
    const TableLayout& layout = table.layout;
    const auto& [texture, first] = places_[index];
    const auto [x, y, z] =
        position_expressions(layout, use, axis_of(layout.width, filter_),
                             rows_of(layout.height, *texture, first), axis_of(layout.depth, filter_));
    const bool line = layout.shape == TableShape::line;
    const ValueType type = table.channels == 1 ? ValueType::real : ValueType::vector;
    if (filter_ == ShaderFilter::hardware) {
      std::vector<Expr> at{x};
      if (!line || texture->height > 0) at.push_back(line ? Expr((first + 0.5) / texture->height) : y);
      return named("value", Expr::sample(texture->name, at, type));
    }
    const Cell across = cell_of(x, layout.width);
    const auto row = [&](const Expr& number) {
      const auto texel = [&](const Expr& column) {
        return named("texel", Expr::texel(texture->name, column, number, type));
      };
      return mix_expression(texel(across.low), texel(across.high), across.fraction);
    };
    if (line) return row(Expr::integer(first));
    const Cell up = cell_of(y, layout.height, first);
    return mix_expression(row(up.low), row(up.high), up.fraction);
  }

 private:
  struct Place {
    const ShaderTexture* texture = nullptr;
    int first_row = 0;
  };

  // The nodes around a position, numbered from `first`, and how far it is from the lower one.
  struct Cell {
    Expr low, high, fraction;
  };
  static Cell cell_of(const Expr& position, int nodes, int first = 0) {
    const CellExpr cell = cell_expression(position, nodes);
    const Expr node = named("i", Expr(Op::to_integer, {cell.node}));
    return {node + Expr::integer(first), node + Expr::integer(first + 1), cell.fraction};
  }

  // A table's rows among its texture's.
  TableAxis rows_of(int nodes, const ShaderTexture& texture, int first) const noexcept {
    if (filter_ == ShaderFilter::exact) return axis_of(nodes, filter_);
    const double rows = std::max(texture.height, 1);
    return {(nodes - 1) / rows, (first + 0.5) / rows};
  }

  const FactoredBrdf& brdf_;
  ShaderFilter filter_;
  std::vector<Place> places_;
};

// [HomomorphicBrdf, eq. 4], each pair multiplied with itself first, as the definition does
Expr lobe_value(const Lookups& lookups, const FactoredBrdf& brdf, std::size_t j) {
  const auto uses = brdf.ordered_factors(j);
  const std::size_t paired = 2 * brdf.pair_count(j);
  const auto& scale = brdf.lobes()[j].scale;
  Expr product = brdf.channels() == 1 ? Expr(scale[0]) : Expr(Op::vector, {scale[0], scale[1], scale[2]});
  for (std::size_t k = 0; k < uses.size(); k += k < paired ? 2 : 1) {
    const Expr value = lookups.value(uses[k]);
    product = product * (k < paired ? value * lookups.value(uses[k + 1]) : value);
  }
  return named("lobe", product);
}

Expr sum_of_lobes(const FactoredBrdf& brdf, const std::vector<ShaderTexture>& textures,
                  const ShaderOptions& options) {
  const Lookups lookups(brdf, textures, options);
  Expr total;
  for (std::size_t j = 0; j < brdf.lobes().size(); ++j) total = total + lobe_value(lookups, brdf, j);
  return total;
}

// C++ has no textures: an array and a function that reads it.
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

std::string declare_textures(const Language& l, const ShaderOptions& options,
                             const std::vector<ShaderTexture>& textures) {
  std::string text;
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const ShaderTexture& texture = textures[i];
    const std::string_view pattern = texture.height == 0                        ? l.texture_1d
                                     : options.filter == ShaderFilter::hardware ? l.filtered_texture
                                                                                : l.texture;
    text += l.texture.empty() ? declare_array(l, texture)
                              : fmt::format(fmt::runtime(pattern), texture.name, i, 2 * i, 2 * i + 1);
  }
  if (l.texture_struct.empty()) return text;
  return fmt::format(fmt::runtime(l.texture_struct), "burnish_" + options.name + "_tables", text);
}

ShaderCost cost_of(const OperationCount& count) noexcept {
  return {.fetches = count.fetches,
          .operations = count.multiplies + count.adds + count.compares,
          .divisions = count.divisions,
          .roots = count.roots,
          .powers = count.transcendentals};
}

std::string local_function(Expr total, const Language& l, const ShaderOptions& options, std::string_view more,
                           ShaderCost& cost) {
  if (total.type() == ValueType::real) {
    total = named("f0", total);
    total = Expr(Op::vector, {total, total, total});
  }
  Graph graph;
  const std::size_t root = graph.add(total);
  const Writer writer(l, graph, {root});
  cost = cost_of(graph.count());
  std::string body = horizon_test(l);
  if (options.language == ShaderLanguage::msl && options.filter == ShaderFilter::hardware)
    body += "  constexpr sampler smooth_sampler(filter::linear, address::clamp_to_edge);\n";
  body += writer.text() + fmt::format(fmt::runtime(l.result), writer.text(root));
  return l.function(ValueType::vector, "burnish_" + options.name, kTwoDirections, more, body);
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
}

// Adds a table below those that the texture has.
void add_table(ShaderTexture& texture, const FactoredBrdf& brdf, std::size_t i) {
  const Table& table = brdf.tables()[i];
  texture.tables.push_back(i);
  texture.first_rows.push_back(texture.height);
  texture.height += table.layout.height;
  texture.values.insert(texture.values.end(), table.values.begin(), table.values.end());
}

std::vector<ShaderTexture> textures_of(const FactoredBrdf& brdf, const ShaderOptions& options) {
  const bool shared = options.language != ShaderLanguage::cpp && brdf.tables().size() > options.most_textures;
  std::vector<ShaderTexture> textures;
  for (std::size_t i = 0; i < brdf.tables().size(); ++i) {
    const Table& table = brdf.tables()[i];
    const auto fits = [&](const ShaderTexture& t) {
      return shared && t.width == table.layout.width && t.channels == table.channels &&
             t.format == table.format;
    };
    auto texture = std::ranges::find_if(textures, fits);
    if (texture == textures.end()) {
      textures.push_back({.name = shared ? fmt::format("burnish_{}_tables{}", options.name, textures.size())
                                  : is_identifier(table.name)
                                      ? fmt::format("burnish_{}_table_{}", options.name, table.name)
                                      : fmt::format("burnish_{}_table{}", options.name, i),
                          .width = table.layout.width,
                          .channels = table.channels,
                          .format = table.format,
                          .values = {},
                          .tables = {},
                          .first_rows = {}});
      texture = textures.end() - 1;
    }
    add_table(*texture, brdf, i);
    if (!shared && options.lines_are_1d && table.layout.shape == TableShape::line) texture->height = 0;
  }
  if (shared && textures.size() > options.most_textures)
    throw Error(fmt::format("shader: expected tables that fit into {} textures, found {} widths and formats",
                            options.most_textures, textures.size()));
  return textures;
}

}  // namespace

std::string_view to_string(ShaderLanguage language) noexcept {
  constexpr std::string_view kNames[] = {"glsl", "glsl_es", "hlsl", "msl", "wgsl", "cpp"};
  return kNames[static_cast<std::size_t>(language)];
}

std::string to_string(const ShaderCost& cost) {
  return fmt::format("{} fetches, {} operations, {} divisions, {} roots, {} powers", cost.fetches,
                     cost.operations, cost.divisions, cost.roots, cost.powers);
}

ShaderFormula shader_formula(const FactoredBrdf& brdf, const ShaderOptions& options) {
  check(brdf, options);
  ShaderFormula formula;
  formula.textures = textures_of(brdf, options);
  formula.value = sum_of_lobes(brdf, formula.textures, options);
  return formula;
}

Shader generate_shader(const FactoredBrdf& brdf, const ShaderOptions& options) {
  ShaderFormula formula = shader_formula(brdf, options);
  const Language& l = language(to_string(options.language));
  const bool cpp = options.language == ShaderLanguage::cpp;
  Shader shader;
  shader.textures = std::move(formula.textures);
  const std::string more =
      options.language == ShaderLanguage::msl ? fmt::format("burnish_{}_tables tables", options.name) : "";
  const std::string function = local_function(formula.value, l, options, more, shader.cost);
  const auto comment_of = [](std::string text) {  // a table's name may hold anything
    for (char& c : text) c = c < ' ' || c > '~' || c == '\\' ? '?' : c;
    return text;
  };
  shader.text = fmt::format(
      "// Generated by burnish from the model {}: change the model, not this file.\n"
      "// burnish_{}(wi, wo): f_r in 1/sr, without the cosine; unit vectors of the local frame, +z the "
      "normal.\n"
      "// {}.\n{}",
      comment_of(model_expression(brdf)), options.name, to_string(shader.cost), l.header);
  if (cpp) shader.text += "namespace burnish_shader {\n";
  shader.text += declare_textures(l, options, shader.textures);
  shader.text += function + world_function(l, options.name, more);
  if (cpp) shader.text += "}  // namespace burnish_shader\n";
  return shader;
}

SplitShader split_shader(const FactoredBrdf& brdf, const ShaderOptions& options) {
  if (options.language != ShaderLanguage::glsl && options.language != ShaderLanguage::glsl_es)
    throw Error(
        fmt::format("shader: expected glsl or glsl_es to split, found {}", to_string(options.language)));
  const Language& l = language(to_string(options.language));
  ShaderFormula formula = shader_formula(brdf, options);
  SplitShader shader;
  shader.textures = std::move(formula.textures);
  shader.declarations = std::string(l.header) + declare_textures(l, options, shader.textures);
  Graph graph;
  const std::size_t root = graph.add(formula.value);
  const Writer writer(l, graph, {root});
  OperationCount view, rest;
  for (const Statement& statement : writer.statements()) {
    const bool lit = graph.reaches(statement.node, "wi");
    (lit ? shader.light : shader.view) += statement.text;
    (lit ? rest : view) += statement.count;
  }
  rest += writer.count(root);
  shader.value = fmt::format("{}({})", l.vector, writer.text(root));
  shader.view_cost = cost_of(view);
  shader.light_cost = cost_of(rest);
  return shader;
}

}  // namespace burnish
