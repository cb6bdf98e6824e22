#include <algorithm>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/shaders/frame_function.h>
#include <burnish/shaders/positions.h>
#include <burnish/shaders/shader.h>

namespace burnish {

namespace {

Axis axis_of(int nodes, ShaderFilter filter) noexcept {
  if (filter == ShaderFilter::exact) return {nodes - 1.0, 0};
  return {(nodes - 1.0) / nodes, 0.5 / nodes};
}

/// The cell of a position: its first node, the node after it, the fraction.
struct Cell {
  std::string low, high, fraction;
};
Cell cell_of(Body& body, const std::string& position, int nodes) {
  const Dialect& d = body.dialect();
  const std::string u = body.scalar(
      "u", fmt::format("min(max({}, {}), {})", position, d.literal(0), d.literal(nodes - 1)), ops(2));
  const std::string base =
      body.scalar("base", fmt::format("min(floor({}), {})", u, d.literal(nodes - 2)), ops(2));
  const std::string low = body.let(d.integer, "i", fmt::format("{}({})", d.integer, base), {});
  return {low, low + " + 1", body.scalar("f", fmt::format("{} - {}", u, base), ops(1))};
}

class Lookups {
 public:
  Lookups(Body& body, const FactoredBrdf& brdf, const std::vector<ShaderTexture>& textures,
          const ShaderOptions& options)
      : body_(body), brdf_(brdf), filter_(options.filter), places_(brdf.tables().size()) {
    for (const ShaderTexture& texture : textures)
      for (std::size_t k = 0; k < texture.tables.size(); ++k)
        places_[texture.tables[k]] = {&texture, texture.first_rows[k]};
  }

  /// The variable with the table's value.
  std::string value(const FactorUse& use) {
    const auto index = static_cast<std::size_t>(use.table);
    const Table& table = brdf_.tables()[index];
    const TableLayout& layout = table.layout;
    const auto& [texture, first] = places_[index];
    const Axis axis_x = axis_of(layout.width, filter_), axis_y = rows_of(layout.height, *texture, first);
    std::string x, y;
    if (layout.shape == TableShape::disk) {
      const auto at = disk_position(body_, use.projection, layout.warp, axis_x, axis_y);
      x = at[0], y = at[1];
    } else {
      x = line_position(body_, use.projection, layout.warp, axis_x);
      if (layout.shape == TableShape::grid) y = line_position(body_, use.projection_y, layout.warp_y, axis_y);
    }
    const Dialect& d = body_.dialect();
    if (filter_ == ShaderFilter::hardware) {
      if (y.empty() && texture->height > 0) y = d.literal((first + 0.5) / texture->height);
      return let("value", d.sample(texture->name, x, y, table.channels), table.channels, {.fetches = 1});
    }
    const Cell cx = cell_of(body_, x, layout.width);
    if (y.empty()) return row(texture->name, cx, std::to_string(first), table.channels);
    const Cell cy = cell_of(body_, y, layout.height);
    const std::string below = first > 0 ? fmt::format(" + {}", first) : "";
    return mix(row(texture->name, cx, cy.low + below, table.channels),
               row(texture->name, cx, cy.high + below, table.channels), cy.fraction, table.channels);
  }

 private:
  struct Place {
    const ShaderTexture* texture = nullptr;
    int first_row = 0;
  };

  // A table's rows among its texture's.
  Axis rows_of(int nodes, const ShaderTexture& texture, int first) const noexcept {
    if (filter_ == ShaderFilter::exact) return axis_of(nodes, filter_);
    const double rows = std::max(texture.height, 1);
    return {(nodes - 1) / rows, (first + 0.5) / rows};
  }
  std::string let(std::string_view hint, const std::string& expression, int channels,
                  const ShaderCost& cost) {
    return channels == 1 ? body_.scalar(hint, expression, cost) : body_.vector(hint, expression, cost);
  }
  std::string texel(const std::string& texture, const std::string& x, const std::string& y, int channels) {
    return let("texel", body_.dialect().fetch(texture, x, y, channels), channels, {.fetches = 1});
  }
  std::string mix(const std::string& low, const std::string& high, const std::string& f, int channels) {
    return let("value", fmt::format("{0} + {2} * ({1} - {0})", low, high, f), channels, ops(3 * channels));
  }
  std::string row(const std::string& texture, const Cell& x, const std::string& y, int channels) {
    const std::string low = texel(texture, x.low, y, channels);
    return mix(low, texel(texture, x.high, y, channels), x.fraction, channels);
  }

  Body& body_;
  const FactoredBrdf& brdf_;
  ShaderFilter filter_;
  std::vector<Place> places_;
};

// [HomomorphicBrdf, eq. 4], each pair multiplied with itself first, as the definition does
std::string lobe_value(Body& body, Lookups& lookups, const FactoredBrdf& brdf, std::size_t j) {
  const Dialect& d = body.dialect();
  const auto uses = brdf.ordered_factors(j);
  const std::size_t paired = 2 * brdf.pair_count(j);
  const int channels = brdf.channels();
  const auto& scale = brdf.lobes()[j].scale;
  const auto width = [&](const FactorUse& use) {
    return brdf.tables()[static_cast<std::size_t>(use.table)].channels;
  };
  std::string product = channels == 1 ? d.literal(scale[0])
                                      : fmt::format("{}({}, {}, {})", d.vector, d.literal(scale[0]),
                                                    d.literal(scale[1]), d.literal(scale[2]));
  int operations = 0;
  for (std::size_t k = 0; k < uses.size(); k += k < paired ? 2 : 1) {
    const std::string value = lookups.value(uses[k]);
    product += k < paired ? fmt::format(" * ({} * {})", value, lookups.value(uses[k + 1])) : " * " + value;
    operations += channels + (k < paired ? width(uses[k]) : 0);
  }
  return body.let(channels == 1 ? d.scalar : d.vector, "lobe", product, ops(operations));
}

std::string sum_of_lobes(Body& body, const FactoredBrdf& brdf, const std::vector<ShaderTexture>& textures,
                         const ShaderOptions& options) {
  Lookups lookups(body, brdf, textures, options);
  std::string total;
  for (std::size_t j = 0; j < brdf.lobes().size(); ++j)
    total += (j ? " + " : "") + lobe_value(body, lookups, brdf, j);
  return total;
}

std::string declare_textures(const Dialect& d, const ShaderOptions& options,
                             const std::vector<ShaderTexture>& textures) {
  const bool filtered = options.filter == ShaderFilter::hardware;
  std::string text;
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const ShaderTexture& texture = textures[i];
    const std::string& name = texture.name;
    switch (d.language) {
      case ShaderLanguage::glsl:
      case ShaderLanguage::glsl_es:
        text += fmt::format("uniform sampler{}D {};\n", texture.height > 0 ? 2 : 1, name);
        break;
      case ShaderLanguage::hlsl:
        text += fmt::format("Texture2D<float4> {} : register(t{});\n", name, i);
        if (filtered) text += fmt::format("SamplerState {}_sampler : register(s{});\n", name, i);
        break;
      case ShaderLanguage::msl:
        text += fmt::format("  texture2d<float> {};\n", name);
        break;
      case ShaderLanguage::wgsl:
        text += fmt::format("@group(0) @binding({}) var {}: texture_2d<f32>;\n", filtered ? 2 * i : i, name);
        if (filtered)
          text += fmt::format("@group(0) @binding({}) var {}_sampler: sampler;\n", 2 * i + 1, name);
        break;
      case ShaderLanguage::cpp: {
        text += fmt::format("BURNISH_CONSTANT float {}[] = {{", name);
        for (std::size_t k = 0; k < texture.values.size(); ++k)
          text += fmt::format("{}{},", k % 8 ? " " : "\n    ", d.literal(texture.values[k]));
        text += "\n};\n";
        const std::string at = fmt::format("{}[{} * (y * {} + x)", name, texture.channels, texture.width);
        text +=
            texture.channels == 1
                ? fmt::format("BURNISH_FUNCTION float {0}_at(int x, int y) {{ return {1}]; }}\n", name, at)
                : fmt::format(
                      "BURNISH_FUNCTION vec3 {0}_at(int x, int y) {{\n"
                      "  return {{{1}], {1} + 1], {1} + 2]}};\n}}\n",
                      name, at);
        break;
      }
    }
  }
  if (d.language != ShaderLanguage::msl) return text;
  return fmt::format("struct burnish_{}_tables {{\n{}}};\n", options.name, text);
}

std::string local_function(const FactoredBrdf& brdf, const Dialect& d, const ShaderOptions& options,
                           const std::vector<ShaderTexture>& textures, std::string_view more,
                           ShaderCost& cost) {
  Body body(d);
  const std::string total = sum_of_lobes(body, brdf, textures, options);
  const std::string zero = d.literal(0);
  std::string result = d.function("burnish_" + options.name, {"wi", "wo"}, more);
  result +=
      fmt::format("  if (wi.z <= {0} || wo.z <= {0}) {{ return {1}({0}, {0}, {0}); }}\n", zero, d.vector);
  if (d.language == ShaderLanguage::msl && options.filter == ShaderFilter::hardware)
    result += "  constexpr sampler smooth_sampler(filter::linear, address::clamp_to_edge);\n";
  cost = body.cost();
  cost.operations += (static_cast<int>(brdf.lobes().size()) - 1) * brdf.channels();
  if (brdf.channels() == 3) return result + body.text() + fmt::format("  return {};\n}}\n", total);
  return result + body.text() + d.declaration(d.scalar, "f0", total) +
         fmt::format("  return {}(f0, f0, f0);\n}}\n", d.vector);
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

std::string to_string(const ShaderCost& cost) {
  return fmt::format("{} fetches, {} operations, {} divisions, {} roots, {} powers", cost.fetches,
                     cost.operations, cost.divisions, cost.roots, cost.powers);
}

Shader generate_shader(const FactoredBrdf& brdf, const ShaderOptions& options) {
  check(brdf, options);
  const Dialect& d = dialect_of(options.language);
  const bool cpp = options.language == ShaderLanguage::cpp;
  Shader shader;
  shader.textures = textures_of(brdf, options);
  const std::string more =
      options.language == ShaderLanguage::msl ? fmt::format("burnish_{}_tables tables", options.name) : "";
  const std::string function = local_function(brdf, d, options, shader.textures, more, shader.cost);
  const auto comment_of = [](std::string text) {  // a table's name may hold anything
    for (char& c : text) c = c < ' ' || c > '~' || c == '\\' ? '?' : c;
    return text;
  };
  shader.text = fmt::format(
      "// Generated by burnish from the model {}: change the model, not this file.\n"
      "// burnish_{}(wi, wo): f_r in 1/sr, without the cosine; unit vectors of the local frame, +z the "
      "normal.\n"
      "// {}.\n{}",
      comment_of(model_expression(brdf)), options.name, to_string(shader.cost), d.header);
  if (cpp) shader.text += "namespace burnish_shader {\n";
  shader.text += declare_textures(d, options, shader.textures);
  shader.text += function + world_function(d, options.name, more);
  if (cpp) shader.text += "}  // namespace burnish_shader\n";
  return shader;
}

SplitShader split_shader(const FactoredBrdf& brdf, const ShaderOptions& options) {
  check(brdf, options);
  if (options.language != ShaderLanguage::glsl && options.language != ShaderLanguage::glsl_es)
    throw Error(
        fmt::format("shader: expected glsl or glsl_es to split, found {}", to_string(options.language)));
  const Dialect& d = dialect_of(options.language);
  SplitShader shader;
  shader.textures = textures_of(brdf, options);
  shader.declarations = std::string(d.header) + declare_textures(d, options, shader.textures);
  Body body(d);
  const std::string total = sum_of_lobes(body, brdf, shader.textures, options);
  shader.value = fmt::format("{}({})", d.vector, total);
  shader.view = body.view_text();
  shader.light = body.light_text();
  shader.view_cost = body.view_cost();
  shader.light_cost = body.light_cost();
  shader.light_cost.operations += (static_cast<int>(brdf.lobes().size()) - 1) * brdf.channels();
  return shader;
}

}  // namespace burnish
