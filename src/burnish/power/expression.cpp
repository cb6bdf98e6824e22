// SPDX-License-Identifier: Apache-2.0
#include <burnish/formula/graph.h>
#include <burnish/power/expression.h>

namespace burnish {
namespace {

Expr exp2(const Expr& a) {
  return {Op::exp2, {a}};
}
Expr exp_of_log(const Expr& a) {
  return exp2(a);
}
Expr short_exp2(const Expr& a) {
  return exp2(a);
}
// The logarithm of 0 is undefined in shaders; the least normal float stands for it.
Expr log2_of_positive(const Expr& a) {
  return {Op::log2, {max(a, 1.2e-38)}};
}
Expr power_at_inflection(const Expr& inverse) {
  return exp2(Expr(0.5) * (Expr(1.0) / inverse - 1.0) * log2_of_positive(Expr(1.0) - inverse));
}
Expr cos_of_root(const Expr& q) {
  constexpr double kHalfTurn = 1.5707963267948966;
  return max(Expr(Op::cos, {Expr(Op::min, {sqrt(q), kHalfTurn})}), 0.0);
}

struct SplitExpr {
  Expr exponent, mantissa;
};
SplitExpr split(const Expr& c) {
  const Expr n(Op::exponent_of, {c});
  return {n, Expr(Op::scale_by_two, {c, Expr(0.0) - n})};
}
struct WholeAndFraction {
  Expr whole, fraction;
};
WholeAndFraction floor_and_fraction(const Expr& y) {
  const Expr whole(Op::floor, {y});
  return {whole, y - whole};
}
Expr scale_by_power_of_two(const Expr& x, const Expr& n) {
  return {Op::scale_by_two, {x, n}};
}

#include <burnish/power/forms-inl.h>

Expr log_cosine(const Cosine<Expr>& p) {
  return log2_of_positive(p.c);
}
Expr squared_angle(const Cosine<Expr>& p) {
  const Expr gamma(Op::acos, {Expr(Op::min, {p.c, 1.0})});
  return gamma * gamma;
}

template <class Form>
Expr value_of(const std::vector<Expr>& k) {
  const Expr c = Expr::input("c");
  return Form::value(Cosine<Expr>{c, Expr(1.0) - c}, k.data());
}
template <class Form>
std::vector<Expr> coefficients_of() {
  std::vector<Expr> k(Form::kCoefficients);
  Form::coefficients(Exponent<Expr>{Expr::input("e"), 1.0}, k.data());
  return k;
}

struct Recorder {
  Expr (*value)(const std::vector<Expr>&);
  std::vector<Expr> (*coefficients)();
};
template <class... Forms>
struct Recorders {
  static constexpr Recorder kAll[] = {{&value_of<Forms>, &coefficients_of<Forms>}...};
};
const Recorder& recorder(PowerMethod method) {
  return AllForms<Recorders>::kAll[static_cast<int>(method)];
}

}  // namespace

Expr power_value_expression(PowerMethod method, const std::vector<Expr>& coefficients) {
  return recorder(method).value(coefficients);
}

std::vector<Expr> power_coefficient_expressions(PowerMethod method) {
  return recorder(method).coefficients();
}

PowerCost count_operations(PowerMethod method) {
  std::vector<Expr> k;
  for (std::size_t i = 0; i < power_coefficient_expressions(method).size(); ++i)
    k.push_back(Expr::input("k" + std::to_string(i)));
  Graph graph;
  graph.add(power_value_expression(method, k));
  const OperationCount count = graph.count();
  return {count.multiplies,          count.adds,  count.compares,
          count.divisions,           count.roots, count.transcendentals,
          static_cast<int>(k.size())};
}

}  // namespace burnish
