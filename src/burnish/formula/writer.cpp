// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/formula/writer.h>

namespace burnish {
namespace {

// The precedence of operators.
constexpr int kChoice = 0, kSum = 1, kProduct = 2, kCall = 3;

}  // namespace

Writer::Writer(const Language& language, const Graph& graph, const std::vector<std::size_t>& roots,
               bool halves)
    : language_(language), graph_(graph), uses_(graph.nodes().size()), names_(graph.nodes().size()) {
  for (const Graph::Node& node : graph.nodes()) half_.push_back(halves && is_half(node));
  for (const Graph::Node& node : graph.nodes()) {
    for (const std::size_t argument : node.arguments) ++uses_[argument];
    if (node.op != Op::input) continue;
    times_[node.name] = 1;
    taken_.insert(node.name);
  }
  for (const std::size_t root : roots) ++uses_[root];
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    if (!is_local(i)) continue;
    const Graph::Node& node = graph.nodes()[i];
    const std::string value = formula(i).text;
    names_[i] = new_name(node.called);
    statements_.push_back({language.declaration(node.type, names_[i], value, half_[i]), i, count_of_text(i)});
  }
}

std::string Writer::text() const {
  std::string all;
  for (const Statement& statement : statements_) all += statement.text;
  return all;
}

bool Writer::uses(Op op) const noexcept {
  return std::ranges::any_of(graph_.nodes(), [&](const Graph::Node& node) { return node.op == op; });
}

OperationCount Writer::count(std::size_t root) const {
  return names_[root].empty() ? count_of_text(root) : OperationCount{};
}

// From texels, or a vector of constants, which only they are multiplied with.
bool Writer::is_half(const Graph::Node& node) const {
  if (node.op == Op::texel || node.op == Op::sample) return true;
  const auto constant = [&](std::size_t a) { return graph_.nodes()[a].op == Op::constant; };
  if (node.op == Op::vector && std::ranges::all_of(node.arguments, constant)) return true;
  return std::ranges::any_of(node.arguments, [&](std::size_t a) { return half_[a]; });
}

// A value that costs nothing is written again; any other that is used twice becomes a local.
bool Writer::is_local(std::size_t i) const {
  const Graph::Node& node = graph_.nodes()[i];
  if (node.op == Op::constant || node.op == Op::input || node.op == Op::component) return false;
  if (!node.called.empty()) return true;
  return uses_[i] > 1 && node.op != Op::negate && node.type != ValueType::integer;
}

OperationCount Writer::count_of_text(std::size_t i) const {
  const Graph::Node& node = graph_.nodes()[i];
  OperationCount count = count_of(node.op, node.type);
  for (const std::size_t argument : node.arguments)
    if (names_[argument].empty()) count += count_of_text(argument);
  return count;
}

std::string Writer::new_name(std::string_view called) {
  for (;;) {
    std::string name = "t";
    if (called.empty()) {
      name += std::to_string(unnamed_++);
    } else {
      name = called;
      if (const int time = ++times_[name]; time > 1) name += std::to_string(time);
    }
    if (taken_.insert(name).second) return name;  // a name's second "t2" may be another's third
  }
}

std::string Writer::operand(std::size_t i, int least_precedence) const {
  const Graph::Node& node = graph_.nodes()[i];
  if (!names_[i].empty()) return names_[i];
  if (node.op == Op::input) return node.name;
  const auto [text, precedence] = formula(i);
  return precedence < least_precedence ? "(" + text + ")" : text;
}

/// In half precision where what it is a factor of is.
std::string Writer::argument(std::size_t i, std::size_t number, int least_precedence) const {
  const Graph::Node& node = graph_.nodes()[i];
  const bool read = node.op == Op::texel || node.op == Op::sample;
  const Graph::Node& argument = graph_.nodes()[node.arguments[number]];
  const bool factor = half_[i] && !read && argument.op == Op::constant && argument.type == ValueType::real;
  return factor ? language_.literal(argument.constant, true)
                : operand(node.arguments[number], least_precedence);
}

std::vector<std::string> Writer::arguments(std::size_t i) const {
  std::vector<std::string> all;
  for (std::size_t k = 0; k < graph_.nodes()[i].arguments.size(); ++k) all.push_back(argument(i, k, 0));
  return all;
}

/// Writes the read of a texture.
std::string Writer::read(std::size_t i) const {
  const Graph::Node& node = graph_.nodes()[i];
  const std::string texel = node.op == Op::texel ? language_.fetch(node.name, arguments(i), node.type)
                                                 : language_.filtered(node.name, arguments(i), node.type);
  const std::string_view convert =
      node.type == ValueType::vector ? language_.half_from_vector : language_.half_from_scalar;
  return half_[i] && !convert.empty() ? fmt::format("{}({})", convert, texel) : texel;
}

/// By the language's pattern.
Writer::Formula Writer::call(std::size_t i) const {
  const Graph::Node& node = graph_.nodes()[i];
  const Language::Call& call = language_.calls.at(node.op);
  std::string a[4];
  for (std::size_t k = 0; k < node.arguments.size(); ++k)
    a[k] = argument(i, k, call.precedence == kCall ? 0 : call.precedence + 1);
  return {fmt::format(fmt::runtime(call.pattern), a[0], a[1], a[2], a[3]), call.precedence};
}

Writer::Formula Writer::formula(std::size_t i) const {
  const Graph::Node& node = graph_.nodes()[i];
  const auto of = [&](std::size_t k, int least) { return argument(i, k, least); };
  // a op b; what stands to the right of an operator keeps its parentheses
  const auto binary = [&](const char* sign, int own) -> Formula {
    return {fmt::format("{} {} {}", of(0, own), sign, of(1, own + 1)), own};
  };
  switch (node.op) {
    case Op::constant:
      return {node.type == ValueType::integer ? fmt::format("{}", node.constant)
                                              : language_.literal(node.constant),
              node.constant < 0 ? kChoice : kCall};
    case Op::input:
      return {node.name, kCall};
    case Op::add:
      return binary("+", kSum);
    case Op::subtract:
      return binary("-", kSum);
    case Op::multiply:
      return binary("*", kProduct);
    case Op::divide:
      return binary("/", kProduct);
    case Op::mul_add:
      return {fmt::format("{} * {} + {}", of(0, kProduct), of(1, kCall), of(2, kProduct)), kSum};
    case Op::neg_mul_add:
      return {fmt::format("{} - {} * {}", of(2, kSum), of(0, kProduct), of(1, kCall)), kSum};
    case Op::negate:
      return {"-" + of(0, kCall), kChoice};
    case Op::vector:
      return {fmt::format("{}({}, {}, {})", half_[i] ? language_.half_constructor : language_.vector,
                          of(0, 0), of(1, 0), of(2, 0)),
              kCall};
    case Op::component:
      return {fmt::format("{}.{}", of(0, kCall), "xyz"[static_cast<std::size_t>(node.constant)]), kCall};
    case Op::element:
      return {fmt::format("{}[{}]", node.name, of(0, 0)), kCall};
    case Op::texel:
    case Op::sample:
      return {read(i), kCall};
    case Op::call:
      return {fmt::format("{}({})", node.name, fmt::join(arguments(i), ", ")), kCall};
    default:
      return call(i);
  }
}

}  // namespace burnish
