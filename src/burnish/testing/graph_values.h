// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <burnish/formula/graph.h>

namespace burnish {

/// Inputs of a graph of numbers and vectors, whose values graph_values computes in double.
struct GraphInputs {
  std::map<std::string, std::array<double, 3>> values;  ///< a number takes the first component
  std::function<double(const std::string&, int)> element = {};
  /// Value of a texture at coordinates.
  std::function<std::array<double, 3>(const std::string&, std::span<const double>)> sample = {};
  /// Rounds every result that depends on a sample.
  std::function<double(double)> round = [](double x) { return x; };
};

/// Returns the value of an operation on the numbers a(0), a(1) and so on.
template <class Arguments>
double operation_value(Op op, const Arguments& a) {
  switch (op) {
    case Op::add:
      return a(0) + a(1);
    case Op::subtract:
      return a(0) - a(1);
    case Op::multiply:
      return a(0) * a(1);
    case Op::divide:
      return a(0) / a(1);
    case Op::mul_add:
      return a(0) * a(1) + a(2);
    case Op::neg_mul_add:
      return a(2) - a(0) * a(1);
    case Op::negate:
      return -a(0);
    case Op::abs:
      return std::abs(a(0));
    case Op::max:
      return std::max(a(0), a(1));
    case Op::min:
      return std::min(a(0), a(1));
    case Op::if_less:
      return a(0) < a(1) ? a(2) : a(3);
    case Op::floor:
      return std::floor(a(0));
    case Op::sqrt:
      return std::sqrt(a(0));
    case Op::power:
      return std::pow(a(0), a(1));
    case Op::exp2:
      return std::exp2(a(0));
    case Op::acos:
      return std::acos(a(0));
    case Op::cos:
      return std::cos(a(0));
    case Op::to_integer:
      return std::trunc(a(0));
    case Op::to_real:
      return a(0);
    default:
      throw std::logic_error("no value of " + std::string(to_string(op)));
  }
}

using GraphValues = std::vector<std::array<double, 3>>;

/// Returns component i of a node, from the values of the nodes before it.
inline double component_value(const Graph& graph, const Graph::Node& node, std::size_t i,
                              const GraphValues& before, const GraphInputs& inputs) {
  const auto argument = [&](std::size_t k, std::size_t component) {
    const std::size_t from = node.arguments[k];
    return before[from][graph.nodes()[from].type == ValueType::vector ? component : 0];
  };
  switch (node.op) {
    case Op::constant:
      return node.constant;
    case Op::input:
      return inputs.values.at(node.name)[i];
    case Op::vector:
      return argument(i, 0);
    case Op::component:
      return argument(0, static_cast<std::size_t>(node.constant));
    case Op::element:
      return inputs.element(node.name, static_cast<int>(argument(0, i)));
    default:
      return operation_value(node.op, [&](std::size_t k) { return argument(k, i); });
  }
}

inline GraphValues graph_values(const Graph& graph, const GraphInputs& inputs) {
  GraphValues all;
  std::vector<bool> sampled;
  for (const Graph::Node& node : graph.nodes()) {
    sampled.push_back(node.op == Op::sample ||
                      std::ranges::any_of(node.arguments, [&](std::size_t a) { return sampled[a]; }));
    std::array<double, 3> value{};
    if (node.op == Op::sample) {
      std::vector<double> at;
      for (const std::size_t a : node.arguments) at.push_back(all[a][0]);
      value = inputs.sample(node.name, at);
    } else {
      for (std::size_t i = 0; i < (node.type == ValueType::vector ? 3 : 1); ++i)
        value[i] = component_value(graph, node, i, all, inputs);
    }
    if (sampled.back())
      for (double& component : value) component = inputs.round(component);
    all.push_back(value);
  }
  return all;
}

}  // namespace burnish
