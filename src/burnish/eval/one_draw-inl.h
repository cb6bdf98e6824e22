// SPDX-License-Identifier: Apache-2.0
// Per-target include: the formulas of visible_half-inl.h for one direction, in plain floats, which the compiler
// contracts to multiply-adds, and searches that compare eight edges at a time.
#if defined(BURNISH_EVAL_ONE_DRAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_ONE_DRAW_INL_H_
#undef BURNISH_EVAL_ONE_DRAW_INL_H_
#else
#define BURNISH_EVAL_ONE_DRAW_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <burnish/eval/sampler_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

struct Real {
  float raw;

  Real() = default;
  HWY_INLINE explicit Real(double x) : raw(static_cast<float>(x)) {}
  HWY_INLINE explicit Real(float x) : raw(x) {}
};
HWY_INLINE Real operator+(Real a, Real b) {
  return Real(a.raw + b.raw);
}
HWY_INLINE Real operator-(Real a, Real b) {
  return Real(a.raw - b.raw);
}
HWY_INLINE Real operator*(Real a, Real b) {
  return Real(a.raw * b.raw);
}
HWY_INLINE Real operator/(Real a, Real b) {
  return Real(a.raw / b.raw);
}
HWY_INLINE Real sqrt(Real a) {
  return Real(std::sqrt(a.raw));
}
HWY_INLINE Real abs(Real a) {
  return Real(std::abs(a.raw));
}
HWY_INLINE Real min(Real a, Real b) {
  return Real(a.raw < b.raw ? a.raw : b.raw);
}
HWY_INLINE Real max(Real a, Real b) {
  return Real(a.raw > b.raw ? a.raw : b.raw);
}
HWY_INLINE Real copy_sign(Real size, Real sign) {
  return Real(std::copysign(size.raw, sign.raw));
}

struct Int {
  std::int32_t raw;

  Int() = default;
  HWY_INLINE explicit Int(std::int32_t x) : raw(x) {}
};
HWY_INLINE Int operator+(Int a, Int b) {
  return Int(a.raw + b.raw);
}
HWY_INLINE Int operator*(Int a, Int b) {
  return Int(a.raw * b.raw);
}
HWY_INLINE Int min(Int a, Int b) {
  return Int(std::min(a.raw, b.raw));
}
HWY_INLINE Int max(Int a, Int b) {
  return Int(std::max(a.raw, b.raw));
}
HWY_INLINE Int next_around(Int a, int last) {
  return Int(a.raw < last ? a.raw + 1 : 0);
}
HWY_INLINE Int to_int(Real a) {
  return Int(static_cast<std::int32_t>(std::abs(a.raw) < 1e9f ? a.raw : 0.0f));  // not-a-number: 0
}
HWY_INLINE Real to_real(Int a) {
  return Real(static_cast<float>(a.raw));
}

struct Comparison {
  bool holds;
};
HWY_INLINE Comparison less_or_equal(Real a, Real b) {
  return {a.raw <= b.raw};
}
HWY_INLINE Real if_true(Comparison c, Real a, Real b) {
  return Real(c.holds ? a.raw : b.raw);
}
HWY_INLINE Int if_true(Comparison c, Int a, Int b) {
  return Int(c.holds ? a.raw : b.raw);
}

struct OneEdgePair {
  Int lower, mass;
};
HWY_INLINE OneEdgePair edge_pair(const std::uint16_t* table, Int i) {
  const std::uint16_t* const at = table + i.raw;
  return {Int(at[0]), Int(static_cast<std::uint16_t>(at[1] - at[0]))};
}

// Counts the edges up to the target. A binary search would wait for every comparison.
template <int kSlices>
HWY_INLINE Int search(const std::uint16_t* table, const Int (&start)[kSlices], const Real (&weight)[kSlices],
                      int count, Real target) {
  using Eight = hn::CappedTag<float, 8>;
  const Eight d;
  const auto limit = hn::Set(d, target.raw);
  std::size_t up_to = 0;
  for (int i = 0; i < count; i += static_cast<int>(hn::MaxLanes(d))) {
    auto edge = hn::Zero(d);
    for (int s = 0; s < kSlices; ++s) {
      const auto edges = hn::LoadU(hn::Rebind<std::uint16_t, Eight>(), table + start[s].raw + i);
      const auto values = hn::ConvertTo(d, hn::PromoteTo(hn::RebindToSigned<Eight>(), edges));
      edge = hn::MulAdd(hn::Set(d, weight[s].raw), values, edge);
    }
    up_to += hn::CountTrue(d, hn::Le(edge, limit));
  }
  return Int(static_cast<std::int32_t>(up_to) - 1);
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
