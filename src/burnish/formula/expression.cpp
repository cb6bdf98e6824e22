// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>
#include <utility>

#include <burnish/formula/expression.h>

namespace burnish {
namespace {

bool is_constant(const Expr& x) {
  return x.node()->op == Op::constant;
}
bool is_constant(const Expr& x, double value) {
  return is_constant(x) && x.node()->constant == value;
}

// Returns the type of an operation that works componentwise.
ValueType type_of(Op op, const std::vector<Expr>& arguments) {
  if (op == Op::vector) return ValueType::vector;
  if (op == Op::to_integer) return ValueType::integer;
  if (op == Op::to_real) return ValueType::real;
  const auto any = [&](ValueType type) {
    return std::ranges::any_of(arguments, [&](const Expr& x) { return x.type() == type; });
  };
  return any(ValueType::vector)    ? ValueType::vector
         : any(ValueType::integer) ? ValueType::integer
                                   : ValueType::real;
}

}  // namespace

std::string_view to_string(Op op) noexcept {
  constexpr std::string_view kNames[] = {
      "constant",    "input",        "add",    "subtract",  "multiply",   "divide",  "mul_add",
      "neg_mul_add", "negate",       "abs",    "max",       "min",        "if_less", "floor",
      "sqrt",        "power",        "exp2",   "log2",      "acos",       "cos",     "sin",
      "exponent_of", "scale_by_two", "vector", "component", "to_integer", "to_real", "element",
      "texel",       "sample",       "call"};
  return kNames[static_cast<std::size_t>(op)];
}

Expr::Expr(double constant)
    : Expr(Node{.op = Op::constant, .constant = constant, .name = {}, .called = {}, .arguments = {}}) {}

Expr Expr::integer(int constant) {
  return Expr(Node{.op = Op::constant,
                   .type = ValueType::integer,
                   .constant = static_cast<double>(constant),
                   .name = {},
                   .called = {},
                   .arguments = {}});
}

Expr::Expr(const Expr& x) = default;
Expr::Expr(Expr&& x) noexcept = default;
Expr& Expr::operator=(const Expr& x) = default;
Expr& Expr::operator=(Expr&& x) noexcept = default;
Expr::~Expr() = default;

Expr Expr::input(std::string name, ValueType type) {
  return of_name(Op::input, type, std::move(name), {});
}

Expr Expr::element(std::string array, const Expr& index, ValueType type) {
  return of_name(Op::element, type, std::move(array), {index});
}

Expr Expr::texel(std::string texture, const std::vector<Expr>& at, ValueType type) {
  return of_name(Op::texel, type, std::move(texture), at);
}

Expr Expr::sample(std::string texture, const std::vector<Expr>& at, ValueType type) {
  return of_name(Op::sample, type, std::move(texture), at);
}

Expr Expr::call(std::string function, const std::vector<Expr>& arguments, ValueType type) {
  return of_name(Op::call, type, std::move(function), arguments);
}

Expr Expr::of_name(Op op, ValueType type, std::string name, const std::vector<Expr>& arguments) {
  Node node{.op = op, .type = type, .name = std::move(name), .called = {}, .arguments = {}};
  for (const Expr& x : arguments) node.arguments.push_back(x.node_);
  return Expr(std::move(node));
}

Expr::Expr(Op op, const std::vector<Expr>& a) {
  const auto value = [&](std::size_t i) { return a[i].node_->constant; };
  const bool foldable =
      std::ranges::all_of(a, [](const Expr& x) { return is_constant(x) && x.type() == ValueType::real; });
  if (foldable && op == Op::add)
    *this = Expr(value(0) + value(1));
  else if (foldable && op == Op::subtract)
    *this = Expr(value(0) - value(1));
  else if (foldable && op == Op::multiply)
    *this = Expr(value(0) * value(1));
  else if (op == Op::multiply && (is_constant(a[0], 1) || is_constant(a[1], 0)))
    *this = a[1];
  else if (op == Op::multiply && (is_constant(a[1], 1) || is_constant(a[0], 0)))
    *this = a[0];
  else if (op == Op::add && is_constant(a[0], 0))
    *this = a[1];
  else if ((op == Op::add || op == Op::subtract) && is_constant(a[1], 0))
    *this = a[0];
  else {
    Node node{.op = op, .type = type_of(op, a), .name = {}, .called = {}, .arguments = {}};
    for (const Expr& x : a) node.arguments.push_back(x.node_);
    *this = Expr(std::move(node));
  }
}

Expr named(const char* name, const Expr& x) {
  const Expr::Node& node = *x.node();
  if (node.op == Op::constant || node.op == Op::input) return x;
  Expr::Node copy = node;
  copy.called = name;
  return Expr(std::move(copy));
}

Expr component(const Expr& vector, int index) {
  return Expr(Expr::Node{.op = Op::component,
                         .constant = static_cast<double>(index),
                         .name = {},
                         .called = {},
                         .arguments = {vector.node()}});
}

Expr operator+(const Expr& a, const Expr& b) {
  return {Op::add, {a, b}};
}
Expr operator-(const Expr& a, const Expr& b) {
  return {Op::subtract, {a, b}};
}
Expr operator*(const Expr& a, const Expr& b) {
  return {Op::multiply, {a, b}};
}
Expr operator/(const Expr& a, const Expr& b) {
  return {Op::divide, {a, b}};
}
Expr operator-(const Expr& a) {
  return {Op::negate, {a}};
}
Expr mul_add(const Expr& a, const Expr& b, const Expr& c) {
  return {Op::mul_add, {a, b, c}};
}
Expr neg_mul_add(const Expr& a, const Expr& b, const Expr& c) {
  return {Op::neg_mul_add, {a, b, c}};
}
Expr max(const Expr& a, const Expr& b) {
  return {Op::max, {a, b}};
}
Expr min(const Expr& a, const Expr& b) {
  return {Op::min, {a, b}};
}
Expr if_less(const Expr& a, const Expr& b, const Expr& x, const Expr& y) {
  return {Op::if_less, {a, b, x, y}};
}
Expr abs(const Expr& a) {
  return {Op::abs, {a}};
}
Expr floor(const Expr& a) {
  return {Op::floor, {a}};
}
Expr sqrt(const Expr& a) {
  return {Op::sqrt, {a}};
}
Expr cos(const Expr& a) {
  return {Op::cos, {a}};
}
Expr sin(const Expr& a) {
  return {Op::sin, {a}};
}
Expr acos(const Expr& a) {
  return {Op::acos, {a}};
}
Expr exp(const Expr& a) {
  return {Op::exp2, {std::numbers::log2e * a}};
}
Expr power(const Expr& a, double exponent) {
  return exponent == 0.5 ? sqrt(a) : Expr(Op::power, {a, exponent});
}

ExprVector::ExprVector(Expr along_x, Expr along_y, Expr along_z)
    : x(std::move(along_x)), y(std::move(along_y)), z(std::move(along_z)) {}

ExprVector::ExprVector(const Expr& vector)
    : x(component(vector, 0)), y(component(vector, 1)), z(component(vector, 2)), vector_(vector) {}

Expr ExprVector::whole() const {
  return vector_ ? *vector_ : Expr(Op::vector, {x, y, z});
}

ExprVector named(const char* name, const ExprVector& v) {
  return ExprVector(named(name, v.whole()));
}
ExprVector operator+(const ExprVector& a, const ExprVector& b) {
  return ExprVector(a.whole() + b.whole());
}
ExprVector operator-(const ExprVector& a, const ExprVector& b) {
  return ExprVector(a.whole() - b.whole());
}
ExprVector operator*(const Expr& a, const ExprVector& b) {
  return ExprVector(a * b.whole());
}
Expr dot(const ExprVector& a, const ExprVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
ExprVector mirror(const ExprVector& v) {
  return {-v.x, -v.y, v.z};
}

}  // namespace burnish
