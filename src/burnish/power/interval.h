// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace burnish {

/// A closed interval that contains the exact result of every operation: each bound is moved outwards by at
/// least the rounding error. Library functions are trusted to 4 units in the last place.
struct Interval {
  double lo = 0, hi = 0;

  constexpr Interval() = default;
  constexpr Interval(double x) : lo(x), hi(x) {}  // NOLINT: numbers are intervals
  constexpr Interval(double low, double high) : lo(low), hi(high) {}

  double mid() const noexcept { return 0.5 * (lo + hi); }
  double width() const noexcept { return hi - lo; }
  double magnitude() const noexcept { return std::max(std::abs(lo), std::abs(hi)); }
};

namespace interval_detail {

constexpr double kTiny = 0x1p-1060;

// x - |x| 2^-52 is at least one unit in the last place below x.
inline double down(double x, double ulps = 1) noexcept {
  return x - std::abs(x) * (ulps * 0x1p-52) - kTiny;
}
inline double up(double x, double ulps = 1) noexcept {
  return x + std::abs(x) * (ulps * 0x1p-52) + kTiny;
}
inline Interval outward(double lo, double hi, double ulps = 1) noexcept {
  return {down(lo, ulps), up(hi, ulps)};
}

}  // namespace interval_detail

inline Interval operator+(Interval a, Interval b) noexcept {
  return interval_detail::outward(a.lo + b.lo, a.hi + b.hi);
}
inline Interval operator-(Interval a, Interval b) noexcept {
  return interval_detail::outward(a.lo - b.hi, a.hi - b.lo);
}
inline Interval operator*(Interval a, Interval b) noexcept {
  const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  return interval_detail::outward(std::min(std::min(p, q), std::min(r, s)),
                                  std::max(std::max(p, q), std::max(r, s)));
}
/// Everything, as far as these proofs are concerned, where the divisor may be zero.
inline Interval operator/(Interval a, Interval b) noexcept {
  if (b.lo <= 0 && b.hi >= 0) return {-1e60, 1e60};
  return a * interval_detail::outward(1 / b.hi, 1 / b.lo);
}

/// Smallest interval that holds both.
inline Interval hull(Interval a, Interval b) noexcept {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}
/// The common part; both must contain the same number.
inline Interval intersect(Interval a, Interval b) noexcept {
  return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

inline Interval max(Interval a, Interval b) noexcept {
  return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)};
}
/// The square, never negative.
inline Interval square(Interval a) noexcept {
  const Interval p = a * a;
  return {a.lo <= 0 && a.hi >= 0 ? 0.0 : std::max(p.lo, 0.0), p.hi};
}

/// The image of a rising function whose computed values are off by at most `ulps`.
template <class F>
Interval rising(Interval a, F f, double ulps = 4) noexcept {
  return interval_detail::outward(f(a.lo), f(a.hi), ulps);
}
template <class F>
Interval falling(Interval a, F f, double ulps = 4) noexcept {
  return interval_detail::outward(f(a.hi), f(a.lo), ulps);
}

inline Interval exp(Interval a) noexcept {
  const Interval r = rising(a, [](double x) { return std::exp(x); });
  return {std::max(r.lo, 0.0), r.hi};
}
/// Domain: the part of a that is >= 0.
inline Interval sqrt(Interval a) noexcept {
  const Interval r = rising(a, [](double x) { return std::sqrt(std::max(x, 0.0)); });
  return {std::max(r.lo, 0.0), r.hi};
}

}  // namespace burnish
