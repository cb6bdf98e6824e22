// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/formula/mantissa.h>
#include <burnish/math/closest_name.h>
#include <burnish/power/expression.h>
#include <burnish/power/power.h>

namespace burnish {
namespace {

// The functions forms-inl.h asks of a number type, for double.
using std::exp2;
using std::max;
using std::sqrt;

double mul_add(double a, double b, double c) {
  return a * b + c;
}
double neg_mul_add(double a, double b, double c) {
  return c - a * b;
}
double if_less(double a, double b, double x, double y) {
  return a < b ? x : y;
}
// t^(e-1) = (1 - V)^((1/V - 1) / 2), 1 at V = 1 where a vanishes.
double power_at_inflection(double inverse) {
  return inverse >= 1 ? 1 : std::exp(0.5 * (1 / inverse - 1) * std::log1p(-inverse));
}
double exp_of_log(double x) {
  return std::exp(x);
}
double short_exp2(double x) {
  return std::exp2(x);
}
double cos_of_root(double q) {
  constexpr double kFirstZero = 2.4674011002723395;  // (pi / 2)^2
  return q < kFirstZero ? std::cos(std::sqrt(q)) : 0.0;
}

struct SplitNumber {
  double exponent, mantissa;
};
// c = mantissa 2^exponent, mantissa in [kLeastMantissa, 2 kLeastMantissa).
SplitNumber split(double c) {
  if (c <= 0) return {-127, 1};  // as the float bits of 0 read
  int n = 0;
  double m = std::frexp(c, &n);
  if (m < kLeastMantissa) {
    m *= 2;
    --n;
  }
  return {static_cast<double>(n), m};
}
struct WholeAndFraction {
  double whole, fraction;
};
WholeAndFraction floor_and_fraction(double y) {
  const double whole = std::floor(y);
  return {whole, y - whole};
}
double scale_by_power_of_two(double x, double n) {
  return std::ldexp(x, static_cast<int>(n));
}

#include <burnish/power/forms-inl.h>

double log_cosine(const Cosine<double>& p) {
  return std::log(p.c);
}
double squared_angle(const Cosine<double>& p) {
  const double gamma = std::acos(p.c);
  return gamma * gamma;
}

struct Definition {
  int count;
  void (*coefficients)(const Exponent<double>&, double*);
  double (*value)(const Cosine<double>&, const double*);
};
template <class... Forms>
struct Definitions {
  static constexpr Definition kAll[] = {{Forms::kCoefficients, &Forms::template coefficients<double>,
                                         &Forms::template value<Cosine<double>, double>}...};
};
const Definition& definition(PowerMethod method) noexcept {
  return AllForms<Definitions>::kAll[static_cast<int>(method)];
}

std::vector<PowerInfo> make_infos() {
  using M = PowerMethod;
  constexpr double kMax = kMaxExponent;
  // clang-format off
  std::vector<PowerInfo> infos = {
      {M::exact, "exact", "c^e", "Phong1975", 1, {{1, kMax, 0}}, {}},
      {M::schlick, "schlick", "c / (c + e u)", "Schlick1994a", 1, {{1, kMax, 0.2037}}, {}},
      {M::lyon, "lyon", "max(0, 1 - e u + e(e-1)/2 u^2 - e(e-1)(e-2)/6 u^3)", "Lyon1993", 4, {{1, kMax, 0.203}}, {}},
      {M::angle2, "angle2", "cos(sqrt(e/2) acos c)^2", "QuadraticBrdf", 1, {{1, kMax, 0.198}}, {}},
      {M::angle4, "angle4", "cos(sqrt(e/4) acos c)^4", "QuadraticBrdf", 1, {{1, kMax, 0.251}, {4, kMax, 0.0502}}, {}},
      {M::angle8, "angle8", "cos(sqrt(e/8) acos c)^8", "QuadraticBrdf", 1, {{1, kMax, 0.273}, {8, kMax, 0.0237}}, {}},
      {M::angle16, "angle16", "cos(sqrt(e/16) acos c)^16", "QuadraticBrdf", 1, {{1, kMax, 0.283}, {16, kMax, 0.0115}}, {}},
      {M::quadratic_raw, "quadratic_raw", "a c^2 + (1 - a) c", "QuadraticBrdf", {}, {{1, kMax, 202}}, {}},
      {M::quadratic, "quadratic", "c max(0, 1 - a u)", "QuadraticBrdf", 1, {{1, kMax, 0.285}, {1, 10, 0.24}}, {}},
      {M::w2, "w2", "max(0, 1 - (0.355945 e + 0.157597) u)^2", "burnish", 1, {{1, kMax, 0.24}, {2, kMax, 0.07}}, {}},
      {M::w4, "w4", "max(0, 1 - (0.211344 e + 0.121098) u)^4", "burnish", 1, {{1, kMax, 0.2}, {2.6, kMax, 0.0361}, {4, kMax, 0.0332}}, {}},
      {M::w8, "w8", "max(0, 1 - (0.114994 e + 0.0766) u)^8", "burnish", 1, {{1, kMax, 0.19}, {5, kMax, 0.0161}}, {}},
      {M::w16, "w16", "max(0, 1 - (0.0599623 e + 0.0322371) u)^16", "burnish", 1, {{1, kMax, 0.22}, {10, kMax, 0.0079}}, {}},
      {M::two_piece, "two_piece", "max(0, m - n u)^2 + o, (m, n, o) by u < s1/e", "burnish", 2, {{2, kMax, 0.0146}}, {}},
      {M::two_piece_paper, "two_piece_paper", "c (1 - a u) where u < s1/e, else max(0, m - n u)^2", "burnish", 2, {{2, kMax, 0.0387}}, {}},
      {M::cubic2, "cubic2", "max(0, 1 - k0 u + k1 u^2 - k2 u^3)^2", "burnish", 1.5, {{1.5, kMax, 0.0035}}, {}},
      {M::cubic4, "cubic4", "max(0, 1 - k0 u + k1 u^2 - k2 u^3)^4", "burnish", 3.5, {{3.5, kMax, 0.00048}}, {}},
      {M::rational, "rational", "c / (c + k0 u + k1 u^3)", "burnish", 1, {{1, kMax, 0.0102}}, {}},
      {M::rational2, "rational2", "(c / (c + k0 u + k1 u^2))^2", "burnish", 2, {{2, kMax, 0.0082}}, {}},
      {M::rational4, "rational4", "(c / (c + k0 u + k1 u^2))^4", "burnish", 4, {{4, kMax, 0.00247}}, {}},
      {M::gaussian, "gaussian", "2^(-e u / ln 2)", "Wang2009", 1, {{1, kMax, 0.3679}, {5, kMax, 0.0582}, {50, kMax, 0.00548}}, {}},
      {M::gaussian2, "gaussian2", "2^(-e (u + u^2/2) / ln 2)", "burnish", 1, {{1, kMax, 0.2232}, {5, kMax, 0.0134}, {50, kMax, 0.00018}}, {}},
      {M::near_exact, "near_exact", "2^(e log2 c), both by polynomials", "burnish", 1, {{1, kMax, 1.85e-6}}, {}},
  };
  // clang-format on
  for (PowerInfo& info : infos) info.cost = count_operations(info.method);
  return infos;
}

// Calls f(c) over samples of the cosine that crowd where the power of this exponent changes.
template <class F>
void for_each_cosine(double exponent, F f) {
  constexpr int kSamples = 20000;
  for (int i = 0; i <= kSamples; ++i) {
    const double x = static_cast<double>(i) / kSamples;
    f(std::max(0.0, 1 - 20 * x / std::max(exponent, 20.0)));
    f(x);
  }
}

}  // namespace

std::span<const PowerInfo> power_methods() {
  static const std::vector<PowerInfo> infos = make_infos();
  return infos;
}

const PowerInfo& power_info(PowerMethod method) {
  return power_methods()[static_cast<std::size_t>(method)];
}

PowerMethod power_method(std::string_view name) {
  std::vector<std::string_view> known;
  for (const PowerInfo& info : power_methods()) {
    if (info.name == name) return info.method;
    known.push_back(info.name);
  }
  throw Error("power method: " + expected_one_of(known, name));
}

double power_bound(PowerMethod method, double exponent) {
  double bound = HUGE_VAL;
  for (const PowerBound& b : power_info(method).bounds)
    if (exponent >= b.min_exponent && exponent <= b.max_exponent) bound = std::min(bound, b.bound);
  if (bound == HUGE_VAL)
    throw Error(fmt::format("exponent of {}: expected {} to {}, found {}", power_info(method).name,
                            power_info(method).min_exponent(), power_info(method).max_exponent(), exponent));
  return bound;
}

PowerCoefficients power_coefficients(PowerMethod method, double exponent) {
  power_bound(method, exponent);  // throws outside the range
  PowerCoefficients result{method, definition(method).count, {}};
  definition(method).coefficients({exponent, 1.0}, result.k.data());
  return result;
}

double power(const PowerCoefficients& coefficients, double cosine) noexcept {
  return definition(coefficients.method).value({cosine, 1 - cosine}, coefficients.k.data());
}

double power(PowerMethod method, double cosine, double exponent) {
  return power(power_coefficients(method, exponent), cosine);
}

double quadratic_coefficient(double exponent) noexcept {
  double a = 0;
  QuadraticRaw::coefficients<double>({exponent, 1.0}, &a);
  return a;
}

double quadratic_coefficient_affine(double exponent) noexcept {
  return -2 * std::expm1(-0.5) * exponent - 0.5;
}

double power_integral(PowerMethod method, double exponent) {
  const PowerCoefficients coefficients = power_coefficients(method, exponent);
  // Four-point Gauss over panels that grow from the centre outwards as the lobe flattens.
  constexpr double kNodes[] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                               0.9305681557970263};
  constexpr double kWeights[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                 0.17392742256872693};
  constexpr int kPanels = 4000;
  const auto u_of = [&](int i) {  // from 0 to 1, first panels a small share of 1/e
    const double x = static_cast<double>(i) / kPanels;
    return std::expm1(x * std::log1p(exponent)) / exponent;
  };
  double sum = 0;
  for (int i = 0; i < kPanels; ++i) {
    const double begin = u_of(i), width = u_of(i + 1) - begin;
    for (int j = 0; j < 4; ++j)
      sum += kWeights[j] * width * power(coefficients, std::max(0.0, 1 - begin - kNodes[j] * width));
  }
  return sum;
}

double power_normalization(PowerMethod method, double exponent) {
  return 1 / ((exponent + 1) * power_integral(method, exponent));
}

double max_relative_error(PowerMethod method, double exponent, double level) {
  const PowerCoefficients coefficients = power_coefficients(method, exponent);
  const double edge = std::pow(level, 1 / exponent);
  constexpr int kSamples = 20000;
  double worst = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const double c = edge + (1 - edge) * i / kSamples;
    worst = std::max(worst, std::abs(power(coefficients, c) / std::pow(c, exponent) - 1));
  }
  return worst;
}

double max_absolute_error(PowerMethod method, double exponent) {
  const PowerCoefficients coefficients = power_coefficients(method, exponent);
  double worst = 0;
  for_each_cosine(exponent, [&](double c) {
    worst = std::max(worst, std::abs(power(coefficients, c) - std::pow(c, exponent)));
  });
  return worst;
}

}  // namespace burnish
