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
namespace burnish {
namespace HWY_NAMESPACE {
namespace {

/// Three vectors of floats: the components of directions.
struct Lanes {
  Lane x, y, z;
};
HWY_INLINE Lanes operator+(const Lanes& a, const Lanes& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Lanes operator-(const Lanes& a, const Lanes& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Lanes operator*(double a, const Lanes& b) {
  const Lane factor(a);
  return {factor * b.x, factor * b.y, factor * b.z};
}
HWY_INLINE Lanes mirror(const Lanes& a) {
  return {Lane(hn::Neg(a.x.raw)), Lane(hn::Neg(a.y.raw)), a.z};
}

HWY_INLINE Lane length(Lane x, Lane y) {
  return sqrt(mul_add(x, x, y * y));
}
HWY_INLINE Lane length(Lane x, Lane y, Lane z) {
  return sqrt(mul_add(z, z, mul_add(x, x, y * y)));
}
HWY_INLINE Lane least_positive(Lane) {
  return Lane(std::numeric_limits<float>::min());
}

/// The exponent 1/2.
struct Half {};
HWY_INLINE Lane power(Lane t, Half) {
  return sqrt(t);
}
HWY_INLINE Lane power(Lane t, Lane exponent) {  // of 0 and not-a-number 0
  const Lane value(hn::Exp(D(), (exponent * Lane(hn::Log(D(), t.raw))).raw));
  return Lane(hn::IfThenElseZero(hn::Gt(t.raw, hn::Zero(D())), value.raw));
}

#define FORMULA_INLINE HWY_INLINE
#define FORMULA_ATTRIBUTE HWY_ATTR
#include <burnish/parameterization/projection-inl.h>
#undef FORMULA_ATTRIBUTE
#undef FORMULA_INLINE

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace burnish
HWY_AFTER_NAMESPACE();

#endif
