// Per-target include: the formulas of power/forms-inl.h over vectors of floats.
#if defined(BURNISH_EVAL_POWER_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_POWER_LANES_INL_H_
#undef BURNISH_EVAL_POWER_LANES_INL_H_
#else
#define BURNISH_EVAL_POWER_LANES_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>

#include <burnish/eval/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

// The exact power by Highway's own functions.
HWY_INLINE Lane exp_of_log(Lane a) {
  return Lane(hn::Exp(D(), a.raw));
}
HWY_INLINE Lane cos_of_root(Lane q) {
  const Lane angle = min(sqrt(q), Lane(1.5707963267948966));
  return max(Lane(hn::Cos(D(), angle.raw)), Lane(0.0));
}

// Splits c = m 2^n, m in [2/3, 4/3), by its bits: subtracting those of 2/3 leaves n above the mantissa.
struct SplitLane {
  Lane exponent, mantissa;
};
HWY_INLINE SplitLane split(Lane c) {
  const DI di;
  const auto bits = hn::BitCast(di, c.raw);
  const auto n = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f2aaaab)));
  return {Lane(hn::ConvertTo(D(), n)), Lane(hn::BitCast(D(), hn::Sub(bits, hn::ShiftLeft<23>(n))))};
}

struct WholeLane {
  Lane shifted, rest;
};
HWY_INLINE WholeLane round_to_whole(Lane y) {
  const Lane magic(kRoundingShift);
  const Lane shifted = y + magic;
  return {shifted, y - (shifted - magic)};
}
HWY_INLINE Lane scale_by_power_of_two(Lane x, Lane shifted) {
  const DI di;
  const auto exponent = hn::ShiftLeft<23>(hn::BitCast(di, shifted.raw));
  return Lane(hn::BitCast(D(), hn::Add(hn::BitCast(di, x.raw), exponent)));
}
HWY_INLINE Lane short_exp2(Lane x);
HWY_INLINE Lane power_at_inflection(Lane inverse);
struct GivenCosine;
HWY_INLINE Lane falling_line(Lane k, const GivenCosine& p);

#include <burnish/power/forms-inl.h>

HWY_INLINE Lane short_exp2(Lane x) {
  const auto [whole, f] = round_to_whole(max(x, Lane(NearExact::kMinPower)));
  return scale_by_power_of_two(NearExact::exp2_near_zero_short(f), whole);
}

// Returns (1 - V)^((e - 1) / 2), e = 1/V, by the near-exact power.
HWY_INLINE Lane power_at_inflection(Lane inverse) {
  const Lane k = (Lane(1.0) / inverse - Lane(1.0)) * Lane(0.5);
  return NearExact::value(Cosine<Lane>{Lane(1.0) - inverse, inverse}, &k);
}

// A cosine that is a float itself, not computed from others with rounding.
struct GivenCosine : Cosine<Lane> {};
HWY_INLINE GivenCosine cosine(Lane c) {
  return {{c, Lane(1.0) - c}};
}
// From k = 1/2 on 1 - k is exact, so a fused k c + (1 - k) rounds once, as 1 - k u does; and u is not needed.
HWY_INLINE Lane falling_line(Lane k, const GivenCosine& p) {
#if HWY_NATIVE_FMA
  return mul_add(k, p.c, Lane(1.0) - k);
#else
  return neg_mul_add(k, p.u, Lane(1.0));
#endif
}
HWY_INLINE Lane log_cosine(const Cosine<Lane>& p) {
  return Lane(hn::Log(D(), p.c.raw));
}
HWY_INLINE Lane squared_angle(const Cosine<Lane>& p) {
  const Lane gamma(hn::Acos(D(), p.c.raw));
  return gamma * gamma;
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
