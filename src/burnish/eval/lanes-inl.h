// SPDX-License-Identifier: Apache-2.0
// Per-target include: vectors of floats with operators, for formulas written once for all number types.
#if defined(BURNISH_EVAL_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_LANES_INL_H_
#undef BURNISH_EVAL_LANES_INL_H_
#else
#define BURNISH_EVAL_LANES_INL_H_
#endif

#include <burnish/math/highway-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

using D = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<D>;

/// 1.5 2^23: added to a float it rounds it to a whole number, which stays in the low bits of the sum.
constexpr double kRoundingShift = 12582912;

/// A vector with as many floats as `Tag` says: the widest vector, or one lane for each of a few values.
template <class Tag>
struct LaneOf {
  using Integers = hn::RebindToSigned<Tag>;
  hn::Vec<Tag> raw;

  LaneOf() = default;
  HWY_INLINE LaneOf(double x)
      : raw(hn::Set(Tag(), static_cast<hn::TFromD<Tag>>(x))) {}  // NOLINT: numbers are constants
  HWY_INLINE explicit LaneOf(hn::Vec<Tag> v) : raw(v) {}

  friend HWY_INLINE LaneOf operator+(LaneOf a, LaneOf b) { return LaneOf(hn::Add(a.raw, b.raw)); }
  friend HWY_INLINE LaneOf operator-(LaneOf a, LaneOf b) { return LaneOf(hn::Sub(a.raw, b.raw)); }
  friend HWY_INLINE LaneOf operator*(LaneOf a, LaneOf b) { return LaneOf(hn::Mul(a.raw, b.raw)); }
  friend HWY_INLINE LaneOf operator/(LaneOf a, LaneOf b) { return LaneOf(hn::Div(a.raw, b.raw)); }
  friend HWY_INLINE LaneOf mul_add(LaneOf a, LaneOf b, LaneOf c) {
    return LaneOf(hn::MulAdd(a.raw, b.raw, c.raw));
  }
  friend HWY_INLINE LaneOf neg_mul_add(LaneOf a, LaneOf b, LaneOf c) {
    return LaneOf(hn::NegMulAdd(a.raw, b.raw, c.raw));
  }
  friend HWY_INLINE LaneOf max(LaneOf a, LaneOf b) { return LaneOf(hn::Max(a.raw, b.raw)); }
  friend HWY_INLINE LaneOf min(LaneOf a, LaneOf b) { return LaneOf(hn::Min(a.raw, b.raw)); }
  // Clamps as integers: negative floats are negative integers, and integer maxima do not compete with the
  // multipliers.
  friend HWY_INLINE LaneOf clamp_negative(LaneOf a) {
    const Integers di;
    return LaneOf(hn::BitCast(Tag(), hn::Max(hn::BitCast(di, a.raw), hn::Zero(di))));
  }
  friend HWY_INLINE LaneOf sqrt(LaneOf a) { return LaneOf(hn::Sqrt(a.raw)); }
  friend HWY_INLINE LaneOf abs(LaneOf a) { return LaneOf(hn::Abs(a.raw)); }
  friend HWY_INLINE LaneOf if_less(LaneOf a, LaneOf b, LaneOf x, LaneOf y) {
    return LaneOf(hn::IfThenElse(hn::Lt(a.raw, b.raw), x.raw, y.raw));
  }
  /// Returns the value where the condition is positive, else 0; also 0 where the condition is not-a-number.
  friend HWY_INLINE LaneOf if_positive(LaneOf condition, LaneOf value) {
    return LaneOf(hn::IfThenElseZero(hn::Gt(condition.raw, hn::Zero(Tag())), value.raw));
  }
};
using Lane = LaneOf<D>;

HWY_INLINE Lane load(const float* from) {
  return Lane(hn::LoadU(D(), from));
}
HWY_INLINE void store(Lane v, float* to) {
  hn::StoreU(v.raw, D(), to);
}

/// Ignores the name: only formulas as text keep names.
template <class T>
HWY_INLINE T named(const char*, const T& x) {
  return x;
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
