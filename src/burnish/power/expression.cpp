#include <algorithm>
#include <cmath>
#include <set>

#include <burnish/power/expression.h>
#include <burnish/power/op_count.h>

namespace burnish {
namespace {

bool is_constant(const Expr& x, double value) {
  return x.node()->op == Op::constant && x.node()->constant == value;
}

}  // namespace

Expr::Expr(double constant) : node_(std::make_shared<const Node>(Node{Op::constant, constant, {}, {}})) {}

Expr Expr::input(std::string name) {
  Expr result;
  result.node_ = std::make_shared<const Node>(Node{Op::input, 0, std::move(name), {}});
  return result;
}

Expr::Expr(Op op, const std::vector<Expr>& a) {
  const bool foldable =
      std::all_of(a.begin(), a.end(), [](const Expr& x) { return x.node_->op == Op::constant; });
  const auto value = [&](std::size_t i) { return a[i].node_->constant; };
  if (foldable && op == Op::multiply)
    *this = Expr(value(0) * value(1));
  else if (op == Op::multiply && is_constant(a[0], 1))
    *this = a[1];
  else if (op == Op::multiply && is_constant(a[1], 1))
    *this = a[0];
  else {
    Node node{op, 0, {}, {}};
    for (const Expr& x : a) node.arguments.push_back(x.node_);
    node_ = std::make_shared<const Node>(std::move(node));
  }
}

namespace {

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
Expr mul_add(const Expr& a, const Expr& b, const Expr& c) {
  return {Op::mul_add, {a, b, c}};
}
Expr neg_mul_add(const Expr& a, const Expr& b, const Expr& c) {
  return {Op::neg_mul_add, {a, b, c}};
}
Expr max(const Expr& a, const Expr& b) {
  return {Op::max, {a, b}};
}
Expr if_less(const Expr& a, const Expr& b, const Expr& x, const Expr& y) {
  return {Op::if_less, {a, b, x, y}};
}
Expr sqrt(const Expr& a) {
  return {Op::sqrt, {a}};
}
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
struct WholeAndRest {
  Expr whole, rest;
};
WholeAndRest round_to_whole(const Expr& y) {
  const Expr whole(Op::floor, {y + 0.5});
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

void count(const Expr::Node* node, std::set<const Expr::Node*>& seen, PowerCost& cost) {
  if (!seen.insert(node).second) return;
  switch (node->op) {
    case Op::constant:
    case Op::input:
      break;
    case Op::add:
    case Op::subtract:
      ++cost.adds;
      break;
    case Op::multiply:
    case Op::scale_by_two:
      ++cost.multiplies;
      break;
    case Op::mul_add:
    case Op::neg_mul_add:
      ++cost.multiplies, ++cost.adds;
      break;
    case Op::divide:
      ++cost.divisions;
      break;
    case Op::max:
    case Op::min:
    case Op::floor:
    case Op::exponent_of:
    case Op::if_less:
      ++cost.compares;
      break;
    case Op::sqrt:
      ++cost.roots;
      break;
    case Op::exp2:
    case Op::log2:
    case Op::acos:
    case Op::cos:
      ++cost.transcendentals;
      break;
  }
  for (const auto& argument : node->arguments) count(argument.get(), seen, cost);
}

}  // namespace

Expr power_value_expression(PowerMethod method, const std::vector<Expr>& coefficients) {
  return recorder(method).value(coefficients);
}

std::vector<Expr> power_coefficient_expressions(PowerMethod method) {
  return recorder(method).coefficients();
}

PowerCost count_operations(PowerMethod method) {
  PowerCost cost;
  std::vector<Expr> k;
  cost.table_words = static_cast<int>(power_coefficient_expressions(method).size());
  for (int i = 0; i < cost.table_words; ++i) k.push_back(Expr::input("k" + std::to_string(i)));
  std::set<const Expr::Node*> seen;
  count(power_value_expression(method, k).node().get(), seen, cost);
  return cost;
}

}  // namespace burnish
