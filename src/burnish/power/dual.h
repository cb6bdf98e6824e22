// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/power/interval.h>

namespace burnish {

/// An interval with the intervals of its derivatives in two variables, for the mean value form
///   f(box) is in f(middle) + f'(box) (box - middle),
/// whose excess shrinks with the square of the box. At kinks (max) the derivative is the hull of both sides,
/// which the mean value theorem for Lipschitz functions allows.
struct Dual {
  Interval value, d0, d1;

  constexpr Dual() = default;
  constexpr Dual(double x) : value(x) {}  // NOLINT: numbers are constant functions
  constexpr Dual(Interval v, Interval by0, Interval by1) : value(v), d0(by0), d1(by1) {}
};

/// if_less below takes the same side in one evaluation of a formula. Where the box lies on both sides it
/// records that and takes the one asked for: both formulas must then keep the bound over the whole box.
struct DualBranch {
  bool ambiguous = false;
  bool first = true;
};
inline DualBranch& dual_branch() noexcept {
  thread_local DualBranch branch;
  return branch;
}

inline Dual operator+(const Dual& a, const Dual& b) noexcept {
  return {a.value + b.value, a.d0 + b.d0, a.d1 + b.d1};
}
inline Dual operator-(const Dual& a, const Dual& b) noexcept {
  return {a.value - b.value, a.d0 - b.d0, a.d1 - b.d1};
}
inline Dual operator*(const Dual& a, const Dual& b) noexcept {
  return {a.value * b.value, a.d0 * b.value + a.value * b.d0, a.d1 * b.value + a.value * b.d1};
}
inline Dual operator/(const Dual& a, const Dual& b) noexcept {
  const Interval q = a.value / b.value;
  return {q, (a.d0 - q * b.d0) / b.value, (a.d1 - q * b.d1) / b.value};
}
inline Dual mul_add(const Dual& a, const Dual& b, const Dual& c) noexcept {
  return a * b + c;
}
inline Dual neg_mul_add(const Dual& a, const Dual& b, const Dual& c) noexcept {
  return c - a * b;
}
inline Dual max(const Dual& a, const Dual& b) noexcept {
  if (a.value.lo >= b.value.hi) return a;
  if (b.value.lo >= a.value.hi) return b;
  return {max(a.value, b.value), hull(a.d0, b.d0), hull(a.d1, b.d1)};
}
/// f(a) with the derivative's image known.
inline Dual chain(Interval image, Interval derivative, const Dual& a) noexcept {
  return {image, derivative * a.d0, derivative * a.d1};
}
inline Dual sqrt(const Dual& a) noexcept {
  const Interval root = sqrt(a.value);
  return chain(root, Interval(0.5) / root, a);
}
inline Dual exp2(const Dual& a) noexcept {
  constexpr double kLn2 = 0.6931471805599453;
  const Interval ln2 = interval_detail::outward(kLn2, kLn2);
  const Interval power = exp(a.value * ln2);
  return chain(power, power * ln2, a);
}
inline Dual short_exp2(const Dual& a) noexcept {
  return exp2(a);
}
inline Dual if_less(const Dual& a, const Dual& b, const Dual& x, const Dual& y) noexcept {
  if (a.value.hi < b.value.lo) return x;
  if (a.value.lo >= b.value.hi) return y;
  dual_branch().ambiguous = true;
  return dual_branch().first ? x : y;
}

}  // namespace burnish
