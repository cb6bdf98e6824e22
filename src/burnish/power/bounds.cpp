// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <vector>

#include <burnish/formula/mantissa.h>
#include <burnish/power/bounds.h>
#include <burnish/power/dual.h>

namespace burnish {
namespace {

using std::numbers::ln2;
using std::numbers::pi;

// Rising functions that the proofs need, off by at most kSlack relative; each is a convergent series with
// positive terms near 0, where its closed form cancels.
constexpr double kSlack = 1e-9 / 0x1p-52;  // in units of the last place
constexpr double kUnbounded = 1e60;        // a derivative of which nothing is known
constexpr double kSeriesEnd = 0.02;
constexpr int kSeriesTerms = 9;  // 0.02^9 < 1e-15

// phi(x) = -log(1 - x) / x = 1 + x/2 + x^2/3 + ...; infinite at 1.
double phi(double x) {
  return x == 0 ? 1 : -std::log1p(-x) / x;
}

double phi_derivative(double x) {
  if (x >= 1) return kUnbounded;
  if (std::abs(x) > kSeriesEnd) return (1 / (1 - x) - phi(x)) / x;
  double sum = 0;
  for (int k = kSeriesTerms; k >= 1; --k) sum = sum * x + k / (k + 1.0);
  return sum;
}

// A(x) = acos(1 - x)^2 = 2 sum (2x)^k / (k^2 binomial(2k, k)); B = A / x from 2 to pi^2/4 on [0, 1].
double angle_series(double x, bool derivative) {
  double coefficients[kSeriesTerms + 1];
  double binomial = 1, power = 1;
  for (int k = 1; k <= kSeriesTerms; ++k) {
    binomial *= 2.0 * (2 * k - 1) / k;
    power *= 2;
    coefficients[k] = 2 * power / (k * k * binomial);
  }
  double sum = 0;
  if (derivative)
    for (int k = kSeriesTerms; k >= 2; --k) sum = sum * x + (k - 1) * coefficients[k];
  else
    for (int k = kSeriesTerms; k >= 1; --k) sum = sum * x + coefficients[k];
  return sum;
}
double angle_ratio(double x) {  // B
  if (x < kSeriesEnd) return angle_series(x, false);
  const double gamma = std::acos(std::max(1 - x, -1.0));
  return gamma * gamma / x;
}
double angle_ratio_derivative(double x) {  // B' = (A' - B) / x, A' = 2 gamma / sin gamma
  if (x < kSeriesEnd) return angle_series(x, true);
  const double gamma = std::acos(std::max(1 - x, -1.0));
  return (2 * gamma / std::sin(gamma) - angle_ratio(x)) / x;
}

// phi of a Dual whose value is below 1.
Dual phi(const Dual& x) {
  return chain(rising(
                   x.value, [](double t) { return phi(t); }, kSlack),
               rising(
                   x.value, [](double t) { return phi_derivative(t); }, kSlack),
               x);
}

Dual exp(const Dual& x) {
  const Interval power = exp(x.value);
  return chain(power, power, x);
}

// t^(e-1) for t = sqrt(1 - V), V = 1/e: exp(-(1 - V) phi(V) / 2) = exp(y log y / (2 V)) with y = 1 - V.
Dual power_at_inflection(const Dual& inverse) {
  if (inverse.value.hi < 0.999) return exp(Dual(-0.5) * (Dual(1.0) - inverse) * phi(inverse));
  // y log y falls from 0 where y < 1/exp(1); its slope at 0 is infinite.
  const double y = interval_detail::up(1 - inverse.value.lo);
  if (y > 0.3) return chain({0, 1}, {-kUnbounded, kUnbounded}, inverse);
  const Interval least = Interval(y * std::log(y) * (1 + 1e-12)) / (Interval(2.0) * Interval(1 - y));
  return chain({exp(least).lo, 1}, {-kUnbounded, kUnbounded}, inverse);
}

// A point of the domain in s = e u (variable 0) and v = 1/e (variable 1); one = v and e = 1 by homogeneity.
struct ScaledPoint {
  Dual c, u;
  Dual s, v;
};

Interval clip(Interval x, double lo, double hi) {
  return {std::clamp(x.lo, lo, hi), std::clamp(x.hi, lo, hi)};
}

// e gamma^2 = s B(s v)
Dual squared_angle(const ScaledPoint& p) {
  const Interval x = clip(p.s.value * p.v.value, 0, 1);
  const Dual ratio = chain(rising(
                               x, [](double t) { return angle_ratio(t); }, kSlack),
                           rising(
                               x, [](double t) { return angle_ratio_derivative(t); }, kSlack),
                           p.s * p.v);
  return p.s * ratio;
}

// cos(sqrt q) up to the first zero, then 0.
Dual cos_of_root(const Dual& q) {
  const Interval inside = clip(q.value, 0, pi * pi / 4);
  const auto f = [](double t) { return std::max(std::cos(std::sqrt(t)), 0.0); };
  const auto slope = [](double t) {  // falls in magnitude from 1/2
    const double root = std::sqrt(t);
    return t < 1e-6 ? -0.5 + t / 12 : -std::sin(root) / (2 * root);
  };
  Interval image = falling(inside, f, 1e4), derivative = rising(inside, slope, kSlack);
  if (q.value.hi >= pi * pi / 4 * (1 - 1e-12)) {
    image = hull(image, 0.0);
    derivative = hull(derivative, 0.0);
  }
  return chain({std::max(image.lo, 0.0), image.hi}, derivative, q);
}

// c^e as a function of s and v, with c = max(0, 1 - s v).
Dual exact_power(const ScaledPoint& p) {
  const Interval s = p.s.value, v = p.v.value;
  const auto power = [](double s_, double v_) { return s_ * v_ >= 1 ? 0.0 : std::exp(-s_ * phi(s_ * v_)); };
  // Falling in both variables. The exponent's rounding error is at most a few units of |s phi|, below 1e-12
  // of the power wherever that is above e^-700.
  Interval value = interval_detail::outward(power(s.hi, v.hi), power(s.lo, v.lo), 4096);
  value.lo = std::max(value.lo, 0.0);

  const Interval x = clip(s * v, 0, 1);
  const Interval one_minus_v = Interval(1.0) - v;
  // d/ds = -c^(e-1) = -exp(-s (1 - v) phi(s v))
  const Interval rate = rising(
      x, [](double t) { return std::min(phi(t), kUnbounded); }, kSlack);
  Interval slope = exp(Interval(0.0) - s * max(one_minus_v, 0.0) * rate);
  slope = intersect(slope, {0.0, 1.0});
  Interval by_v;
  if (x.hi < 0.9) {
    // -c^e s^2 phi'(s v)
    const Interval growth = rising(
        x, [](double t) { return phi_derivative(t); }, kSlack);
    by_v = Interval(0.0) - value * square(s) * growth;
  } else {
    // -e^2 (u c^(e-1) + c^e log c), with y log y = e c^e log c in [-1/e, 0] for y = c^e
    const Interval e = Interval(1.0) / v;
    const auto y_log_y = [](double y) { return y > 0 ? y * std::log(y) : 0.0; };
    const double at_lo = y_log_y(value.lo), at_hi = y_log_y(std::min(value.hi, 1.0));
    const double peak = 1 / std::numbers::e;
    Interval entropy = interval_detail::outward(std::min(at_lo, at_hi), std::max(at_lo, at_hi), 64);
    if (value.lo <= peak && value.hi >= peak) entropy.lo = interval_detail::down(-peak);
    by_v = Interval(0.0) - (square(e) * x * slope + e * entropy);
  }
  if (s.hi * v.hi >= 1) {  // the constant 0 beyond c = 0
    slope = hull(slope, 0.0);
    by_v = hull(by_v, 0.0);
  }
  return {value, Interval(0.0) - slope, by_v};
}

// A range of ScaledPoints.
struct ScaledBox {
  double s0, s1, v0, v1;
};

// Beyond c = 0 either the constant 0, for mean values across the edge, or nothing: then c is clipped to the
// domain and keeps its derivatives.
ScaledPoint point_of(const ScaledBox& b, bool constant_outside = true) {
  const Dual s({b.s0, b.s1}, 1.0, 0.0), v({b.v0, b.v1}, 0.0, 1.0);
  const Dual line = Dual(1.0) - s * v;
  Dual c = constant_outside ? max(line, Dual(0.0)) : line;
  c.value = clip(c.value, 0, 1);
  return {c, s, s, v};
}

#include <burnish/power/forms-inl.h>

template <class Form>
Dual member_value(const ScaledPoint& p) {
  if constexpr (std::is_same_v<Form, Exact> || std::is_same_v<Form, NearExact>) {
    return exact_power(p);  // NearExact is proved apart
  } else {
    Dual k[6];
    Form::template coefficients<Dual>({Dual(1.0), p.v}, k);
    return Form::value(p, k);
  }
}

using ValueFunction = Dual (*)(const ScaledPoint&);
template <class... Forms>
struct ValueFunctions {
  static constexpr ValueFunction kAll[] = {&member_value<Forms>...};
};
ValueFunction value_function(PowerMethod method) {
  return AllForms<ValueFunctions>::kAll[static_cast<int>(method)];
}

// Calls accept(f over the box, f at its middle) for both branches of the formula where it has two.
template <class F, class Accept>
bool all_branches(const ScaledPoint& box, const ScaledPoint& middle, F f, Accept accept) {
  DualBranch& branch = dual_branch();
  branch = {};
  const Dual over = f(box);
  const bool ambiguous = branch.ambiguous;
  branch.ambiguous = false;
  if (!accept(over, f(middle))) return false;
  if (!ambiguous) return true;
  branch = {.ambiguous = false, .first = false};
  const Dual other = f(box);
  return accept(other, f(middle));
}

struct Verdict {
  bool accepted = true;
  bool refuted = false;
  double across_s = 0, across_v = 0;  // how much each variable contributes to the excess
};

// Halves boxes until `examine` accepts them all or refutes one.
template <class Examine>
BoundProof subdivide(ScaledBox domain, std::size_t max_boxes, Examine examine) {
  BoundProof proof;
  std::vector<ScaledBox> stack{domain};
  while (!stack.empty()) {
    const ScaledBox box = stack.back();
    stack.pop_back();
    if (box.s0 * box.v0 > 1.0000001) continue;  // no cosine there
    if (++proof.boxes > max_boxes) return proof;
    const double s = 0.5 * (box.s0 + box.s1), v = 0.5 * (box.v0 + box.v1);
    const Verdict verdict = examine(box, ScaledBox{s, s, v, v}, proof);
    if (verdict.refuted) return proof;
    if (verdict.accepted) continue;
    ScaledBox a = box, b = box;
    if (verdict.across_s >= verdict.across_v)
      a.s1 = b.s0 = s;
    else
      a.v1 = b.v0 = v;
    stack.push_back(a);
    stack.push_back(b);
  }
  proof.proved = true;
  return proof;
}

double contribution(Interval derivative, double width) {
  return std::min(derivative.magnitude(), 20.0) * width;
}

// |error| <= bound over the domain.
template <class F>
BoundProof prove_small(F error, ScaledBox domain, double bound, std::size_t max_boxes) {
  return subdivide(domain, max_boxes, [&](const ScaledBox& box, const ScaledBox& middle, BoundProof& proof) {
    const Interval ds(interval_detail::down(box.s0 - middle.s0), interval_detail::up(box.s1 - middle.s0));
    const Interval dv(interval_detail::down(box.v0 - middle.v0), interval_detail::up(box.v1 - middle.v0));
    Verdict verdict;
    verdict.accepted =
        all_branches(point_of(box), point_of(middle), error, [&](const Dual& over, const Dual& at) {
          verdict.across_s = std::max(verdict.across_s, contribution(over.d0, box.s1 - box.s0));
          verdict.across_v = std::max(verdict.across_v, contribution(over.d1, box.v1 - box.v0));
          const Interval enclosure = intersect(over.value, at.value + over.d0 * ds + over.d1 * dv);
          return enclosure.lo >= -bound && enclosure.hi <= bound;
        });
    if (middle.s0 * middle.v0 <= 1) {
      dual_branch() = {};
      const Interval met = error(point_of(middle)).value;
      proof.attained = std::max(proof.attained, std::max(met.lo, -met.hi));
      verdict.refuted = proof.attained > bound;
    }
    return verdict;
  });
}

// A function of s alone, for the one-dimensional parts of the proof of NearExact.
template <class F>
bool prove_small_1d(F error, double lo, double hi, double bound) {
  const auto of_s = [&](const ScaledPoint& p) { return error(p.s); };
  return prove_small(of_s, {lo, hi, 0, 0}, bound, 10'000'000).proved;
}

ScaledBox scaled_domain(double min_exponent, double max_exponent) {
  const double v0 = 1 / max_exponent, v1 = 1 / min_exponent;
  return {0, max_exponent, interval_detail::down(v0), v1 == 1 ? 1 : interval_detail::up(v1)};
}

// log2(1 + t) = t phi(-t) / ln 2.
Dual log2_ratio_exact(const Dual& t) {
  return phi(Dual(0.0) - t) * Dual(interval_detail::outward(1 / ln2, 1 / ln2), 0.0, 0.0);
}

// With L the polynomial logarithm and P the polynomial exponential of NearExact, x = e |ln c| and
// y = e log2 c:
//   |L(c) - log2 c| <= r |log2 c|  gives  |2^(e L) - c^e| <= r max x exp(-x (1 - r)) <= r / exp(1) (1 + 2 r),
//   |P(f) - 2^f| <= 2 p for f in [0, 1), where the power of two is at most 1/2 unless f = 0 and P is exact, adds p,
//   and the smallest power of two returned adds 2^-125.
double near_exact_bound(double r, double p) {
  return interval_detail::up(r / std::numbers::e * (1 + 3 * r) + p + 0x1p-124, 16);
}

constexpr double kLogError = 4.8e-6, kExpError = 7.9e-8;

bool prove_near_exact_parts() {
  // n = 0, t <= 0: relative to log2(1 + t)
  const auto ratio_error = [](const Dual& t) {
    const Dual ratio = log2_ratio_exact(t);
    return (NearExact::log2_ratio(t) - ratio) / ratio;
  };
  constexpr double kLeast = kLeastMantissa - 1e-6,
                   kMost = 2 * kLeastMantissa + 1e-6;  // m, with the split's rounding
  const bool centre = prove_small_1d(ratio_error, kLeast - 1, 0, kLogError);
  // n <= -1: |log2 c| >= 1 - log2(1 + t)
  const auto error = [&](const Dual& t) {
    const Dual log2_m = t * log2_ratio_exact(t);
    return (t * NearExact::log2_ratio(t) - log2_m) / (Dual(1.0) - log2_m);
  };
  const bool rest = prove_small_1d(error, kLeast - 1, kMost - 1, kLogError);
  const auto of_fraction = [](const Dual& f) { return NearExact::exp2_of_fraction(f) - exp2(f); };
  const auto of_mantissa = [](const Dual& f) { return NearExact::exp2_of_mantissa(f + Dual(1.0)) - exp2(f); };
  return centre && rest && prove_small_1d(of_fraction, 0, 1, 2 * kExpError) &&
         prove_small_1d(of_mantissa, 0, 1, 2 * kExpError);
}

// The polynomial as the kernel of the exact power computes it, but for fused roundings.
template <std::size_t count>
double horner(double x, const double (&coefficients)[count]) {
  double sum = coefficients[count - 1];
  for (std::size_t i = count - 1; i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

// Largest |L(c) - log2 c| / |log2 c| over all floats c in (0, 1), L the kernel's: each has one of 2^23 mantissas m in
// [2/3, 4/3). A power of two below 1 adds to log2 m < 0.42 a whole number, which is exact: the first counts most.
double exact_log_error() {
  constexpr int kMantissas = 1 << 23;
  constexpr double kStep = 0x1p-23;
  double worst = 0;
  for (int i = 0; i < kMantissas; ++i) {
    double m = 1 + i * kStep;
    if (m >= 4.0 / 3) m /= 2;
    const double t = m - 1;
    if (t == 0) continue;  // L = 0 there
    const long double log2_m = std::log1p(static_cast<long double>(t)) / std::numbers::ln2_v<long double>;
    const long double size = t < 0 ? -log2_m : 1 - log2_m;
    const double error = static_cast<double>(std::abs(t * horner(t, Exact::kLog2) - log2_m) / size);
    worst = std::max(worst, error);
  }
  return worst;
}

// Largest |P(f) / 2^f - 1| for |f| <= 1/2: on a grid, and beside it by the slope (P' - ln 2 P) / 2^f, whose
// coefficients' magnitudes bound it.
double exact_exp_error() {
  constexpr int kPoints = 1 << 14;
  double worst = 0;
  for (int i = 0; i <= kPoints; ++i) {
    const double f = static_cast<double>(i) / kPoints - 0.5;
    const long double power = std::exp2(static_cast<long double>(f));
    worst = std::max(worst, static_cast<double>(std::abs(horner(f, Exact::kExp2) / power - 1)));
  }
  constexpr int kDegree = std::size(Exact::kExp2) - 1;
  double slope = 0, scale = std::numbers::sqrt2;
  for (int i = 0; i <= kDegree; ++i, scale *= 0.5) {
    const double derivative = i < kDegree ? (i + 1) * Exact::kExp2[i + 1] : 0;
    slope += scale * std::abs(derivative - ln2 * Exact::kExp2[i]);
  }
  return worst + slope / (2 * kPoints);
}

}  // namespace

double proved_exact_ulps() {
  constexpr double kLeastOctave = 150;    // below 2^-150 a float is 0
  constexpr double kRoundings = 0x1p-49;  // of some twenty operations in doubles
  const double log_error = kLeastOctave * ln2 * (exact_log_error() + kRoundings);
  // 2^-24 of a float is half a unit of its last place or less; the one rounding to a float adds a half
  return 0.5 + std::ldexp(log_error * (1 + log_error) + exact_exp_error() + kRoundings, 24);
}

BoundProof prove_power_bound(PowerMethod method, const PowerBound& range, std::size_t max_boxes) {
  if (method == PowerMethod::near_exact)
    return {prove_near_exact_parts() && near_exact_bound(kLogError, kExpError) <= range.bound, 0, 0};
  const ValueFunction value = value_function(method);
  const auto error = [&](const ScaledPoint& p) { return value(p) - exact_power(p); };
  return prove_small(error, scaled_domain(range.min_exponent, range.max_exponent), range.bound, max_boxes);
}

BoundProof prove_power_monotone(PowerMethod method, double min_exponent, double max_exponent,
                                std::size_t max_boxes) {
  const ValueFunction value = value_function(method);
  constexpr double kZero = 1e-300;  // what outward rounding makes of 0
  return subdivide(scaled_domain(min_exponent, max_exponent), max_boxes,
                   [&](const ScaledBox& box, const ScaledBox& middle, BoundProof& proof) {
                     Verdict verdict;
                     const bool inside = middle.s0 * middle.v0 < 1;
                     verdict.accepted = all_branches(point_of(box, false), point_of(middle, false), value,
                                                     [&](const Dual& over, const Dual& at) {
                                                       if (inside)
                                                         proof.attained = std::max(proof.attained, at.d0.lo);
                                                       verdict.refuted = proof.attained > kZero;
                                                       return over.d0.hi <= kZero;
                                                     });
                     // Relative widths: the derivative's own derivative is not known.
                     verdict.across_s = (box.s1 - box.s0) / (1 + box.s0);
                     verdict.across_v = (box.v1 - box.v0) / (0.05 + box.v0);
                     return verdict;
                   });
}

BoundProof prove_affine_coefficient(double min_exponent, double max_exponent, double factor) {
  // a / e - 2 (1 - exp(-1/2)) + v / 2 within factor v^2
  const auto error = [&](const ScaledPoint& p) {
    Dual k;
    QuadraticRaw::coefficients<Dual>({Dual(1.0), p.v}, &k);
    const double slope = -2 * std::expm1(-0.5);
    return (k - Dual(interval_detail::outward(slope, slope), 0.0, 0.0)) / p.v + Dual(0.5);
  };
  const auto scaled = [&](const ScaledPoint& p) { return error(p) / p.v; };
  return prove_small(scaled, {0, 0, 1 / max_exponent, 1 / min_exponent}, factor, 1'000'000);
}

}  // namespace burnish
