// SPDX-License-Identifier: Apache-2.0
// Per-target include: the formulas of parameterization/projection-inl.h over vectors of floats.
#if defined(BURNISH_EVAL_PROJECTION_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_PROJECTION_LANES_INL_H_
#undef BURNISH_EVAL_PROJECTION_LANES_INL_H_
#else
#define BURNISH_EVAL_PROJECTION_LANES_INL_H_
#endif

#include <limits>
#include <type_traits>

#include <hwy/contrib/math/math-inl.h>

#include <burnish/eval/lanes-inl.h>
#include <burnish/parameterization/projection.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

/// Three vectors of floats: the components of directions.
template <class Tag>
struct LanesOf {
  LaneOf<Tag> x, y, z;

  friend HWY_INLINE LanesOf operator+(const LanesOf& a, const LanesOf& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend HWY_INLINE LanesOf operator-(const LanesOf& a, const LanesOf& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend HWY_INLINE LanesOf operator*(double a, const LanesOf& b) {
    const LaneOf<Tag> factor(a);
    return {factor * b.x, factor * b.y, factor * b.z};
  }
  friend HWY_INLINE LanesOf mirror(const LanesOf& a) {
    return {LaneOf<Tag>(hn::Neg(a.x.raw)), LaneOf<Tag>(hn::Neg(a.y.raw)), a.z};
  }
};
using Lanes = LanesOf<D>;

template <class Tag>
HWY_INLINE LaneOf<Tag> length(LaneOf<Tag> x, LaneOf<Tag> y) {
  return sqrt(mul_add(x, x, y * y));
}
template <class Tag>
HWY_INLINE LaneOf<Tag> length(LaneOf<Tag> x, LaneOf<Tag> y, LaneOf<Tag> z) {
  return sqrt(mul_add(z, z, mul_add(x, x, y * y)));
}
template <class Tag>
HWY_INLINE LaneOf<Tag> least_positive(LaneOf<Tag>) {
  return LaneOf<Tag>(std::numeric_limits<float>::min());
}

/// The exponent 1/2.
struct Half {};
template <class Tag>
HWY_INLINE LaneOf<Tag> power(LaneOf<Tag> t, Half) {
  return sqrt(t);
}
template <class Tag>
HWY_INLINE LaneOf<Tag> power(LaneOf<Tag> t, LaneOf<Tag> exponent) {  // 0 for 0 and not-a-number
  const LaneOf<Tag> log(hn::Log(Tag(), t.raw));
  return if_positive(t, LaneOf<Tag>(hn::Exp(Tag(), (exponent * log).raw)));
}

#define FORMULA_INLINE HWY_INLINE
#define FORMULA_ATTRIBUTE HWY_ATTR
#include <burnish/parameterization/projection-inl.h>
#undef FORMULA_ATTRIBUTE
#undef FORMULA_INLINE

/// wi and wo for the formulas of projections.
template <class Tag>
struct LanePairOf {
  LanesOf<Tag> sum, apart;
  LaneOf<Tag> length_of_sum;

  HWY_INLINE LaneOf<Tag> sum_length() const { return length_of_sum; }
};

/// | |w|^2 - 1 | as an integer, which is largest for not-a-number.
template <class Tag>
HWY_INLINE hn::Vec<hn::RebindToSigned<Tag>> excess_of(LaneOf<Tag> x, LaneOf<Tag> y, LaneOf<Tag> z) {
  const LaneOf<Tag> signed_excess = mul_add(x, x, mul_add(y, y, mul_add(z, z, LaneOf<Tag>(-1.0))));
  return hn::BitCast(hn::RebindToSigned<Tag>(), hn::Abs(signed_excess.raw));
}
/// A vector is no direction if its squared length is off by at least this: 1 % of length, as in readers of
/// directions.
constexpr float kMaxExcess = 0.02f;
/// Returns the lanes whose vectors are no directions.
HWY_INLINE hn::Mask<DI> no_directions(hn::Vec<DI> excess) {
  return hn::Gt(excess, hn::BitCast(DI(), hn::Set(D(), kMaxExcess)));
}

/// Returns the doubled difference vector 2 d, whose z is |wi + wo|, and its polar angle.
template <class Tag>
HWY_INLINE Affine<LanesOf<Tag>, LaneOf<Tag>> doubled_difference(const LanePairOf<Tag>& pair) {
  const auto [u, v] = across_half(pair.sum, pair.length_of_sum, pair.apart);
  const LanesOf<Tag> d{u, v, pair.length_of_sum};
  return {d, polar_of(d, length(u, v, d.z))};
}

/// Clamps a position to the cells. Not-a-number, from directions below the horizon, becomes 0.
template <class Tag>
HWY_INLINE LaneOf<Tag> within(LaneOf<Tag> position, LaneOf<Tag> cells) {
  return if_positive(position, min(position, cells));
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
