#pragma once

#include <memory>
#include <string>
#include <vector>

#include <burnish/power/power.h>

namespace burnish {

enum class Op {
  constant,
  input,
  add,
  subtract,
  multiply,
  divide,
  mul_add,      // a b + c
  neg_mul_add,  // c - a b
  max,
  min,
  if_less,  // a < b ? c : d
  sqrt,
  exp2,
  log2,
  acos,
  cos,
  floor,
  exponent_of,   // n where a = m 2^n, m in [2/3, 4/3)
  scale_by_two,  // a 2^b, b whole
};

/// A node of an expression graph: as number type of the formulas it records what they compute.
class Expr {
 public:
  struct Node {
    Op op;
    double constant = 0;
    std::string input;
    std::vector<std::shared_ptr<const Node>> arguments;
  };

  Expr() : Expr(0.0) {}
  Expr(double constant);  // NOLINT: numbers are expressions
  static Expr input(std::string name);
  /// A node over its arguments; folds constants and drops 1 * x and x + 0.
  Expr(Op op, const std::vector<Expr>& arguments);

  const std::shared_ptr<const Node>& node() const noexcept { return node_; }

 private:
  std::shared_ptr<const Node> node_;
};

/// The member's value as a graph over the inputs "c" and k0, k1, …: the given coefficients' expressions.
Expr power_value_expression(PowerMethod method, const std::vector<Expr>& coefficients);

/// The member's coefficients as graphs over the input "e".
std::vector<Expr> power_coefficient_expressions(PowerMethod method);

}  // namespace burnish
