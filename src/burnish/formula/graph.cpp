// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <burnish/formula/graph.h>

namespace burnish {

std::size_t Graph::add(const Expr& expression) {
  kept_.push_back(expression);
  return add(*expression.node());
}

std::size_t Graph::add(const Expr::Node& node) {
  if (const auto place = places_.find(&node); place != places_.end()) return place->second;
  std::vector<std::size_t> arguments;
  for (const auto& argument : node.arguments) arguments.push_back(add(*argument));
  const auto [known, added] =
      known_.try_emplace({node.op, node.type, node.constant, node.name, arguments}, nodes_.size());
  if (added)
    nodes_.push_back({node.op, node.type, node.constant, node.name, node.called, std::move(arguments)});
  else if (Node& same = nodes_[known->second]; same.called.empty())
    same.called = node.called;
  return places_[&node] = known->second;
}

bool Graph::reaches(std::size_t node, std::string_view input) const {
  std::vector<bool> reached(node + 1);
  for (std::size_t i = 0; i <= node; ++i)
    reached[i] = (nodes_[i].op == Op::input && nodes_[i].name == input) ||
                 std::ranges::any_of(nodes_[i].arguments, [&](std::size_t a) { return reached[a]; });
  return reached[node];
}

OperationCount Graph::count() const noexcept {
  OperationCount sum;
  for (const Node& node : nodes_) sum += count_of(node.op, node.type);
  return sum;
}

}  // namespace burnish
