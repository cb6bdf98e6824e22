// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/export/tsl_function.h>
#include <burnish/formula/graph.h>
#include <burnish/formula/language.h>

namespace burnish {

namespace {

// Returns the pattern of an operation on nodes: {0}, {1}, ...; empty for operations that have none.
std::string_view tsl_pattern(Op op) noexcept {
  switch (op) {
    case Op::add:
      return "{0}.add({1})";
    case Op::subtract:
      return "{0}.sub({1})";
    case Op::multiply:
      return "{0}.mul({1})";
    case Op::divide:
      return "{0}.div({1})";
    case Op::mul_add:
      return "{0}.mul({1}).add({2})";
    case Op::neg_mul_add:
      return "{2}.sub({0}.mul({1}))";
    case Op::negate:
      return "{0}.negate()";
    case Op::abs:
      return "{0}.abs()";
    case Op::max:
      return "{0}.max({1})";
    case Op::min:
      return "{0}.min({1})";
    case Op::if_less:
      return "TSL.select({0}.lessThan({1}), {2}, {3})";
    case Op::floor:
      return "{0}.floor()";
    case Op::sqrt:
      return "{0}.sqrt()";
    case Op::power:
      return "{0}.pow({1})";
    case Op::exp2:
      return "{0}.exp2()";
    case Op::log2:
      return "{0}.log2()";
    case Op::acos:
      return "{0}.acos()";
    case Op::cos:
      return "{0}.cos()";
    case Op::sin:
      return "{0}.sin()";
    case Op::vector:
      return "TSL.vec3({0}, {1}, {2})";
    default:
      return {};
  }
}

std::string tsl_text(const Graph::Node& node, const std::vector<std::string>& a) {
  if (node.op == Op::component)
    return fmt::format("{}.{}", a[0], "xyz"[static_cast<std::size_t>(node.constant)]);
  if (node.op == Op::sample)
    return fmt::format("read(\"{}\", {}).{}", node.name, fmt::join(a, ", "),
                       node.type == ValueType::vector ? "rgb" : "r");
  const std::string_view pattern = tsl_pattern(node.op);
  if (pattern.empty())
    throw Error(
        fmt::format("three: expected an operation of its shading language, found {}", to_string(node.op)));
  std::string arguments[4];
  for (std::size_t k = 0; k < a.size(); ++k) arguments[k] = a[k];
  return fmt::format(fmt::runtime(pattern), arguments[0], arguments[1], arguments[2], arguments[3]);
}

}  // namespace

std::string tsl_function(const Expr& value) {
  Graph graph;
  const std::size_t root =
      graph.add(value.type() == ValueType::real ? Expr(Op::vector, {value, value, value}) : value);
  std::vector<int> uses(graph.nodes().size());
  for (const Graph::Node& node : graph.nodes())
    for (const std::size_t argument : node.arguments) ++uses[argument];

  // A value becomes a variable of the shader if it is used again or its expression is deep: three.js asks a node for
  // its type by asking its arguments, again and again, and stops at variables.
  constexpr int kDeepest = 4;
  std::string body;
  std::vector<std::string> names;
  std::vector<int> depths(graph.nodes().size());
  const Language& numbers = language("glsl");
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    const Graph::Node& node = graph.nodes()[i];
    if (node.op == Op::constant) {
      names.push_back(fmt::format("TSL.float({})", numbers.literal(node.constant)));
      continue;
    }
    if (node.op == Op::input) {
      names.push_back(node.name);
      continue;
    }
    std::vector<std::string> arguments;
    for (const std::size_t argument : node.arguments) {
      arguments.push_back(names[argument]);
      depths[i] = std::max(depths[i], 1 + depths[argument]);
    }
    const std::string text = tsl_text(node, arguments);
    if ((uses[i] < 2 && depths[i] < kDeepest) || node.op == Op::component) {
      names.push_back(text);
      continue;
    }
    depths[i] = 0;
    names.push_back(fmt::format("t{}", i));
    body += fmt::format("  const {} = set(\"{}\", {});\n", names.back(),
                        node.type == ValueType::vector ? "vec3" : "float", text);
  }
  return fmt::format(
      "function reflectance(TSL, read, wi, wo) {{\n"
      "  const set = (type, value) => {{\n"
      "    const variable = TSL.property(type);\n    variable.assign(value);\n    return variable;\n  }};\n{}"
      "  return TSL.select(wi.z.min(wo.z).greaterThan(0), {}, TSL.vec3(0));\n}}\n",
      body, names[root]);
}

}  // namespace burnish
