// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <burnish/eval/sampler_expression.h>
#include <burnish/formula/writer.h>
#include <burnish/shaders/frame_function.h>
#include <burnish/shaders/sampler_shader.h>
#include <burnish/shaders/texture_declaration.h>

namespace burnish {

namespace {

constexpr std::size_t kSamplerTextureNumber = 9;

// The header of C++ has no vectors but those of three numbers.
constexpr std::string_view kCppVectors = R"(#ifndef BURNISH_SAMPLE_TYPES
#define BURNISH_SAMPLE_TYPES
namespace burnish_shader {
struct vec2 {
  float x, y;
  BURNISH_FUNCTION vec2(float a, float b) : x(a), y(b) {}
};
struct vec4 {
  float x, y, z, w;
  BURNISH_FUNCTION vec4(float a, float b, float c, float d) : x(a), y(b), z(c), w(d) {}
  BURNISH_FUNCTION vec4(vec3 v, float d) : x(v.x), y(v.y), z(v.z), w(d) {}
};
BURNISH_FUNCTION int min(int a, int b) { return b < a ? b : a; }
BURNISH_FUNCTION int max(int a, int b) { return a < b ? b : a; }
}  // namespace burnish_shader
#endif
)";

// Returns the name of the vector of `count` numbers: vec4f where the vector of three is vec3f.
std::string vector_of(const Language& l, char count) {
  std::string type(l.vector);
  type[type.find('3')] = count;
  return type;
}

// Writes a function whose parameters are vectors: `last` of two numbers where it is not empty, all others of three.
std::string sampler_function(const Language& l, std::string_view type, std::string_view name,
                             std::span<const std::string_view> vectors, std::string_view last,
                             std::string_view more, std::string_view body) {
  std::string parameters;
  const auto add = [&](const std::string& parameter) {
    parameters += (parameters.empty() ? "" : ", ") + parameter;
  };
  for (const std::string_view p : vectors) add(fmt::format(fmt::runtime(l.parameter), l.vector, p));
  if (!last.empty()) add(fmt::format(fmt::runtime(l.parameter), vector_of(l, '2'), last));
  if (!more.empty()) add(std::string(more));
  return fmt::format(fmt::runtime(l.definition), type, name, parameters, body);
}

// Puts both tables into rows of a texture, see SamplerArrays.
ShaderTexture texture_of(const SamplerTables& tables, const std::string& name) {
  ShaderTexture texture;
  texture.name = name;
  texture.width = kSamplerTextureWidth;
  texture.format = TableFormat::single;
  for (const std::span<const std::uint16_t> table : {tables.row_edges, tables.cell_edges}) {
    texture.values.insert(texture.values.end(), table.begin(), table.end());
    while (texture.values.size() % kSamplerTextureWidth != 0) texture.values.push_back(0);
  }
  texture.height = static_cast<int>(texture.values.size()) / kSamplerTextureWidth;
  return texture;
}

std::string array_of(std::string_view name, std::span<const std::uint16_t> values) {
  std::string text = fmt::format("BURNISH_CONSTANT unsigned short {}[] = {{", name);
  for (std::size_t k = 0; k < values.size(); ++k)
    text += fmt::format("{}{},", k % 16 ? " " : "\n    ", values[k]);
  return text + "\n};\n";
}

ShaderCost cost_of(const Graph& graph, int textures) noexcept {
  const OperationCount count = graph.count();
  return {.fetches = count.fetches,
          .textures = textures,
          .operations = count.multiplies + count.adds + count.compares,
          .divisions = count.divisions,
          .roots = count.roots,
          .powers = count.transcendentals};
}

}  // namespace

SamplerShader generate_shader(const SamplerTables& tables, ShaderLanguage language, const std::string& name,
                              const ShaderPlaces& places) {
  check_shader_name(name);
  check_places(places);
  const Language& l = burnish::language(to_string(language));
  const bool cpp = language == ShaderLanguage::cpp, msl = language == ShaderLanguage::msl;
  const std::string prefix = fmt::format("burnish_{}_sample", name),
                    pdf_name = fmt::format("burnish_{}_pdf", name);
  SamplerShader shader;
  SamplerArrays arrays{.row_edges = prefix + "_rows", .cell_edges = prefix + "_cells"};
  std::string declared;
  if (cpp) {
    declared = array_of(arrays.row_edges, tables.row_edges) + array_of(arrays.cell_edges, tables.cell_edges);
  } else {
    shader.texture = texture_of(tables, prefix + "_tables");
    arrays.texture = shader.texture.name;
    declared = declared_texture(l, l.texture, arrays.texture, kSamplerTextureNumber,
                                {.language = language, .places = places});
  }
  const std::string in_struct = prefix + "_textures";
  if (!l.texture_struct.empty()) declared = fmt::format(fmt::runtime(l.texture_struct), in_struct, declared);

  // Each function is one graph, whose text is its statements and a result.
  const ExprVector wi(Expr::input("wi", ValueType::vector)), wo(Expr::input("wo", ValueType::vector)),
      u(Expr::input("u", ValueType::vector));
  Graph sample, pdf;
  const DrawnExpr drawn = sample_expression(tables, wo, u, arrays);
  std::vector<std::size_t> roots;
  for (const Expr* const value : {&drawn.x, &drawn.y, &drawn.z, &drawn.pdf})
    roots.push_back(sample.add(*value));
  const std::size_t density = pdf.add(pdf_expression(tables, wi, wo, arrays));
  const Writer sample_text(l, sample, roots), pdf_text(l, pdf, {density});
  shader.sample_cost = cost_of(sample, cpp ? 2 : 1);
  shader.pdf_cost = cost_of(pdf, cpp ? 2 : 1);

  const std::string more = msl ? in_struct + " tables" : "", more_name = msl ? ", tables" : "";
  const std::string four = vector_of(l, '4'), zero = l.literal(0);
  const auto result = [&](const std::string& value) { return fmt::format(fmt::runtime(l.result), value); };
  const auto local = [&](char w) {
    return fmt::format("{0}(dot(t, {1}), dot(s, {1}), dot(n, {1}))", l.vector, w);
  };
  constexpr std::string_view kView[] = {"wo"}, kPair[] = {"wi", "wo"}, kViewInWorld[] = {"n", "t", "v"},
                             kPairInWorld[] = {"n", "t", "l", "v"};
  const std::string binormal = l.declaration(ValueType::vector, "s", "cross(n, t)");
  shader.text = fmt::format(
      "// Generated by burnish: change the model, not this file.\n"
      "// {0}(wo, u): a direction to the light and its density in 1/sr, 0 where there is no light.\n"
      "// {1}(wi, wo): that density of any direction. Unit vectors of the local frame, +z the normal; u: "
      "two\n"
      "// numbers of [0, 1). {0}_world(n, t, v, u), {1}_world(n, t, l, v): in any frame.\n"
      "// A draw: {2}.\n// A density: {3}.\n{4}{5}{6}{7}",
      prefix, pdf_name, to_string(shader.sample_cost), to_string(shader.pdf_cost), l.header,
      cpp ? kCppVectors : "", cpp ? "namespace burnish_shader {\n" : "", declared);
  shader.text +=
      sampler_function(l, four, prefix, kView, "u", more,
                       fmt::format("  if (wo.z <= {0}) {{ return {1}({0}, {0}, {0}, {0}); }}\n", zero, four) +
                           sample_text.text() +
                           result(fmt::format("{}({}, {}, {}, {})", four, sample_text.text(roots[0]),
                                              sample_text.text(roots[1]), sample_text.text(roots[2]),
                                              sample_text.text(roots[3]))));
  shader.text += sampler_function(l, l.scalar, pdf_name, kPair, "", more,
                                  fmt::format("  if (wi.z <= {0} || wo.z <= {0}) {{ return {0}; }}\n", zero) +
                                      pdf_text.text() + result(pdf_text.text(density)));
  // A drawn direction is turned back into the frame of the world.
  shader.text +=
      sampler_function(l, four, prefix + "_world", kViewInWorld, "u", more,
                       binormal +
                           fmt::format(fmt::runtime(l.local), four, "drawn",
                                       fmt::format("{}({}, u{})", prefix, local('v'), more_name)) +
                           result(fmt::format("{}(drawn.x * t + drawn.y * s + drawn.z * n, drawn.w)", four)));
  shader.text += sampler_function(
      l, l.scalar, pdf_name + "_world", kPairInWorld, "", more,
      binormal + result(fmt::format("{}({}, {}{})", pdf_name, local('l'), local('v'), more_name)));
  if (cpp) shader.text += "}  // namespace burnish_shader\n";
  return shader;
}

}  // namespace burnish
