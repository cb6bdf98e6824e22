// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  negate,
  abs,
  max,
  min,
  if_less,  // a < b ? c : d
  floor,
  sqrt,
  power,  // a^b
  exp2,
  log2,
  acos,
  cos,
  sin,
  exponent_of,   // n where a = m 2^n, as mantissa.h splits it
  scale_by_two,  // a 2^b, b whole
  vector,        // (a, b, c)
  component,     // number `constant` of a vector
  to_integer,    // the integer part
  to_real,       // of an integer
  element,       // of an array `name`, at integer a
  texel,         // of texture `name` at integers (a, b) or (a, b, c)
  sample,        // of texture `name`, filtered, at one to three coordinates
  call,          // of a function `name` that the text around has
};

/// The enumerator's name.
std::string_view to_string(Op op) noexcept;

/// The type of a node's value: a number, three of them, or an integer that numbers nodes of a table.
enum class ValueType { real, vector, integer };

/// A node of an expression graph: as number type of the formulas it records what they compute.
class Expr {
 public:
  struct Node {
    Op op;
    ValueType type = ValueType::real;
    double constant = 0;
    std::string name;         // of an input, a texture, an array or a function
    std::string_view called;  // what the formula calls the value, or empty; a literal
    std::vector<std::shared_ptr<const Node>> arguments;
  };

  Expr() : Expr(0.0) {}
  Expr(double constant);  // NOLINT: numbers are expressions
  // These stand in expression.cpp, because formulas make hundreds of copies, which would be inlined.
  Expr(const Expr& x);
  Expr(Expr&& x) noexcept;
  Expr& operator=(const Expr& x);
  Expr& operator=(Expr&& x) noexcept;
  ~Expr();
  static Expr integer(int constant);
  static Expr input(std::string name, ValueType type = ValueType::real);
  static Expr element(std::string array, const Expr& index, ValueType type);
  /// Reads a texture, at as many coordinates as it has dimensions: `type` tells whether one or three channels are
  /// read.
  static Expr texel(std::string texture, const std::vector<Expr>& at, ValueType type);
  static Expr sample(std::string texture, const std::vector<Expr>& at, ValueType type);
  static Expr call(std::string function, const std::vector<Expr>& arguments, ValueType type);
  /// A node over its arguments, of vectors componentwise; folds sums and products of constants, drops 1 * x,
  /// 0 * x and x + 0.
  Expr(Op op, const std::vector<Expr>& arguments);

  const std::shared_ptr<const Node>& node() const noexcept { return node_; }
  ValueType type() const noexcept { return node_->type; }

  /// The same value under a name that text keeps.
  friend Expr named(const char* name, const Expr& x);
  /// Component 0, 1 or 2 of a vector.
  friend Expr component(const Expr& vector, int index);

 private:
  static Expr of_name(Op op, ValueType type, std::string name, const std::vector<Expr>& arguments);
  explicit Expr(Node node) : node_(std::make_shared<const Node>(std::move(node))) {}

  std::shared_ptr<const Node> node_;
};

Expr named(const char* name, const Expr& x);
Expr component(const Expr& vector, int index);

Expr operator+(const Expr& a, const Expr& b);
Expr operator-(const Expr& a, const Expr& b);
Expr operator*(const Expr& a, const Expr& b);
Expr operator/(const Expr& a, const Expr& b);
Expr operator-(const Expr& a);
Expr mul_add(const Expr& a, const Expr& b, const Expr& c);
Expr neg_mul_add(const Expr& a, const Expr& b, const Expr& c);
Expr max(const Expr& a, const Expr& b);
Expr min(const Expr& a, const Expr& b);
Expr if_less(const Expr& a, const Expr& b, const Expr& x, const Expr& y);
Expr abs(const Expr& a);
Expr floor(const Expr& a);
Expr sqrt(const Expr& a);
Expr cos(const Expr& a);
Expr sin(const Expr& a);
Expr acos(const Expr& a);
/// e^a, as a power of 2.
Expr exp(const Expr& a);
/// a^exponent, a >= 0; a root where the exponent is 1/2.
Expr power(const Expr& a, double exponent);

/// A direction of the formulas: its components, and the vector they belong to where there is one, so that
/// sums of directions stay one operation in text.
struct ExprVector {
  Expr x, y, z;

  ExprVector(Expr along_x, Expr along_y, Expr along_z);
  explicit ExprVector(const Expr& vector);

  /// The vector, composed of the components where it has been none.
  Expr whole() const;

 private:
  std::optional<Expr> vector_;
};

ExprVector named(const char* name, const ExprVector& v);
ExprVector operator+(const ExprVector& a, const ExprVector& b);
ExprVector operator-(const ExprVector& a, const ExprVector& b);
ExprVector operator*(const Expr& a, const ExprVector& b);
Expr dot(const ExprVector& a, const ExprVector& b);
/// (-x, -y, z)
ExprVector mirror(const ExprVector& v);

}  // namespace burnish
