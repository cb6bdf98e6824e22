// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/formula/graph.h>
#include <burnish/formula/language.h>

namespace burnish {

/// One local variable of written code.
struct Statement {
  std::string text;
  std::size_t node;      ///< whose value it holds
  OperationCount count;  ///< of what its text computes
};

/// Writes a graph as statements of a language: a value that the formula names, or that is used more than
/// once, becomes a local. The order of operations is the formula's.
class Writer {
 public:
  /// For all values of the graph; `roots` are those that text() will be asked for. Names that are inputs of
  /// the graph are not given to locals. `halves`: what is computed from texels is in half precision, with the
  /// constants that it is multiplied with.
  Writer(const Language& language, const Graph& graph, const std::vector<std::size_t>& roots,
         bool halves = false);

  const std::vector<Statement>& statements() const noexcept { return statements_; }
  /// Their text together.
  std::string text() const;
  /// A root's value: its local's name, or an expression.
  std::string text(std::size_t root) const { return operand(root, 0); }
  /// Returns the count of a root's expression; nothing where it is a local's name.
  OperationCount count(std::size_t root) const;
  /// Returns true if the statements call the language's exponent_of.
  bool uses(Op op) const noexcept;

 private:
  bool is_half(const Graph::Node& node) const;
  bool is_local(std::size_t node) const;
  std::string operand(std::size_t node, int least_precedence) const;
  /// Text, and how tightly its outermost operator binds.
  struct Formula {
    std::string text;
    int precedence;
  };
  Formula formula(std::size_t node) const;
  Formula call(std::size_t node) const;
  std::string read(std::size_t node) const;
  std::string argument(std::size_t node, std::size_t number, int least_precedence) const;
  std::vector<std::string> arguments(std::size_t node) const;
  OperationCount count_of_text(std::size_t node) const;
  std::string new_name(std::string_view called);

  const Language& language_;
  const Graph& graph_;
  std::vector<int> uses_;
  std::vector<bool> half_;          // by node
  std::vector<std::string> names_;  // of locals, by node
  std::map<std::string, int, std::less<>> times_;
  std::set<std::string> taken_;
  int unnamed_ = 0;
  std::vector<Statement> statements_;
};

}  // namespace burnish
