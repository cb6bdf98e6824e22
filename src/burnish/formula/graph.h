// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <burnish/formula/expression.h>
#include <burnish/formula/operation_count.h>

namespace burnish {

/// Expressions with everything they share found: every value once, arguments before what is made of them.
class Graph {
 public:
  struct Node {
    Op op;
    ValueType type;
    double constant;
    std::string name;         // as Expr::Node's
    std::string_view called;  // likewise
    std::vector<std::size_t> arguments;
  };

  /// Adds what is new of an expression; returns the number of its value's node.
  std::size_t add(const Expr& expression);

  std::span<const Node> nodes() const noexcept { return nodes_; }
  /// Returns true if the value depends on an input of that name.
  bool reaches(std::size_t node, std::string_view input) const;
  /// Counts the operations of all nodes together, each once.
  OperationCount count() const noexcept;

 private:
  using Key = std::tuple<Op, ValueType, double, std::string, std::vector<std::size_t>>;

  std::vector<Node> nodes_;
  std::map<Key, std::size_t> known_;
  std::map<const Expr::Node*, std::size_t> places_;
  std::vector<Expr> kept_;  // what places_ points into

  std::size_t add(const Expr::Node& node);
};

}  // namespace burnish
