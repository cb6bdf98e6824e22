// Per-target include: vectors of floats with operators, for formulas written once for all number types.
#if defined(BURNISH_EVAL_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_LANES_INL_H_
#undef BURNISH_EVAL_LANES_INL_H_
#else
#define BURNISH_EVAL_LANES_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace burnish {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<D>;

/// 1.5 2^23: added to a float it rounds it to a whole number, which stays in the low bits of the sum.
constexpr double kRoundingShift = 12582912;

struct Lane {
  hn::Vec<D> raw;

  Lane() = default;
  HWY_INLINE Lane(double x) : raw(hn::Set(D(), static_cast<float>(x))) {}  // NOLINT: numbers are constants
  HWY_INLINE explicit Lane(hn::Vec<D> v) : raw(v) {}
};

HWY_INLINE Lane operator+(Lane a, Lane b) {
  return Lane(hn::Add(a.raw, b.raw));
}
HWY_INLINE Lane operator-(Lane a, Lane b) {
  return Lane(hn::Sub(a.raw, b.raw));
}
HWY_INLINE Lane operator*(Lane a, Lane b) {
  return Lane(hn::Mul(a.raw, b.raw));
}
HWY_INLINE Lane operator/(Lane a, Lane b) {
  return Lane(hn::Div(a.raw, b.raw));
}
HWY_INLINE Lane mul_add(Lane a, Lane b, Lane c) {
  return Lane(hn::MulAdd(a.raw, b.raw, c.raw));
}
HWY_INLINE Lane neg_mul_add(Lane a, Lane b, Lane c) {
  return Lane(hn::NegMulAdd(a.raw, b.raw, c.raw));
}
HWY_INLINE Lane max(Lane a, Lane b) {
  return Lane(hn::Max(a.raw, b.raw));
}
HWY_INLINE Lane min(Lane a, Lane b) {
  return Lane(hn::Min(a.raw, b.raw));
}
// As integers: negative floats are negative integers, and integer maxima do not compete with the multipliers.
HWY_INLINE Lane clamp_negative(Lane a) {
  const DI di;
  return Lane(hn::BitCast(D(), hn::Max(hn::BitCast(di, a.raw), hn::Zero(di))));
}
HWY_INLINE Lane sqrt(Lane a) {
  return Lane(hn::Sqrt(a.raw));
}
HWY_INLINE Lane abs(Lane a) {
  return Lane(hn::Abs(a.raw));
}
HWY_INLINE Lane if_less(Lane a, Lane b, Lane x, Lane y) {
  return Lane(hn::IfThenElse(hn::Lt(a.raw, b.raw), x.raw, y.raw));
}
/// Text alone keeps the names that formulas give.
template <class T>
HWY_INLINE T named(const char*, const T& x) {
  return x;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace burnish
HWY_AFTER_NAMESPACE();

#endif
