// SPDX-License-Identifier: Apache-2.0
// Per-target include: the formulas of power/forms-inl.h over vectors of floats.
#if defined(BURNISH_EVAL_POWER_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_POWER_LANES_INL_H_
#undef BURNISH_EVAL_POWER_LANES_INL_H_
#else
#define BURNISH_EVAL_POWER_LANES_INL_H_
#endif

#include <cmath>

#include <hwy/contrib/math/math-inl.h>

#include <burnish/eval/lanes-inl.h>
#include <burnish/formula/mantissa.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

HWY_INLINE Lane cos_of_root(Lane q) {
  const Lane angle = min(sqrt(q), Lane(1.5707963267948966));
  return max(Lane(hn::Cos(D(), angle.raw)), Lane(0.0));
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
template <class Form>
Lane near_exact_kernel(Lane c, Lane e);
template <class Form>
Lane exact_kernel(Lane c, Lane e);
HWY_INLINE Lane power_at_inflection(Lane inverse);
struct GivenCosine;
HWY_INLINE Lane falling_line(Lane k, const GivenCosine& p);

#include <burnish/power/forms-inl.h>

// NearExact on vectors. Ports that multiply floats are the bottleneck, so integers and logic do as much as possible.
// Its coefficients are those of the polynomial log2_ratio times the exponent, computed once a span; octaves are
// counted in units of `kOctave`.
#if BURNISH_TARGET_IS_AVX3
constexpr double kOctave = 1;
#else
constexpr double kOctave = 8388608;  // 2^23: the whole part of a sum in these units is a float's exponent
#endif

struct NearExactSpan {
  Lane log2[6], e;

  HWY_INLINE explicit NearExactSpan(double exponent) : e(exponent * kOctave / 8388608) {
    for (int i = 0; i < 6; ++i) log2[i] = Lane(NearExact::kLog2[i] * exponent * kOctave);
  }
  HWY_INLINE Lane ratio(Lane t) const {
    Lane sum = log2[5];
    for (int i = 4; i >= 0; --i) sum = mul_add(sum, t, log2[i]);
    return sum;
  }
};

// Splits c = m 2^n by its bits, as in mantissa.h: the excess over kLeastMantissaBits, without its mantissa, is n
// 2^23.
struct SplitLane {
  Lane exponent, mantissa;  // n 2^23 and m
};
HWY_INLINE SplitLane split_bits(Lane c) {
  const DI di;
  const auto bits = hn::BitCast(di, c.raw);
  const auto n =
      hn::And(hn::Sub(bits, hn::Set(di, kLeastMantissaBits)), hn::Set(di, static_cast<int>(0xff800000)));
  return {Lane(hn::ConvertTo(D(), n)), Lane(hn::BitCast(D(), hn::Sub(bits, n)))};
}

// Returns 2^y for y >= kMinPower in units of kOctave.
HWY_INLINE Lane exp2_of_octaves(Lane y) {
#if BURNISH_TARGET_IS_AVX3
  constexpr int kFloor = 9;  // imm8: no scale, towards minus infinity, no exceptions
  const Lane f{hn::Vec<D>{_mm512_reduce_ps(y.raw.raw, kFloor)}};
  return Lane(hn::Vec<D>{_mm512_scalef_ps(NearExact::exp2_of_fraction(f).raw.raw, y.raw.raw)});
#else
  const DI di;
#if HWY_TARGET == HWY_AVX2
  const hn::Vec<DI> fixed{_mm256_cvtps_epi32(y.raw.raw)};  // it fits; Highway also handles larger sums
#else
  const auto fixed = hn::NearestInt(y.raw);
#endif
  const auto whole = hn::And(fixed, hn::Set(di, static_cast<int>(0xff800000)));
  const auto one = hn::Set(di, 0x3f800000);
  const Lane m(hn::BitCast(D(), hn::Or(hn::And(fixed, hn::Set(di, 0x007fffff)), one)));
  return Lane(hn::BitCast(D(), hn::Add(hn::BitCast(di, NearExact::exp2_of_mantissa(m).raw), whole)));
#endif
}

HWY_INLINE Lane near_exact_of_span(Lane c, const NearExactSpan& k) {
  const auto [n, m] = split_bits(c);
  const Lane t = m - Lane(1.0);
  return exp2_of_octaves(max(mul_add(k.ratio(t), t, k.e * n), Lane(NearExact::kMinPower * kOctave)));
}

template <class Form>
HWY_INLINE Lane near_exact_kernel(Lane c, Lane e) {
  const auto [n, m] = split_bits(c);
  const Lane t = m - Lane(1.0);
  const Lane by_t = t * (e * Lane(kOctave)), by_n = n * (e * Lane(kOctave / 8388608));
  return exp2_of_octaves(max(mul_add(Form::log2_ratio(t), by_t, by_n), Lane(Form::kMinPower * kOctave)));
}

// Evaluates the polynomial by its even and odd halves: the chain of multiply-adds is half as long, for one more
// multiply.
template <class L, std::size_t count>
HWY_INLINE L polynomial_by_halves(L x, const double (&k)[count]) {
  const L square = x * x;
  L even(k[(count - 1) / 2 * 2]), odd(k[count / 2 * 2 - 1]);
  for (std::size_t i = (count - 1) / 2; i-- > 0;) even = mul_add(even, square, L(k[2 * i]));
  for (std::size_t i = count / 2 - 1; i-- > 0;) odd = mul_add(odd, square, L(k[2 * i + 1]));
  return mul_add(odd, x, even);
}

// The exact power in doubles, half of the lanes at a time: rounded once, at the end.
#if HWY_HAVE_FLOAT64 && HWY_TARGET != HWY_SCALAR
using DD = hn::Repartition<double, D>;
using DDI = hn::RebindToUnsigned<DD>;
using HalfD = hn::Half<D>;
using Doubles = LaneOf<DD>;

HWY_INLINE hn::Vec<DDI> word(uint64_t x) {
  return hn::Set(DDI(), x);
}

// c^e for c in [0, 1]; c = m 2^n, m in [2/3, 4/3).
#if BURNISH_TARGET_IS_AVX3
HWY_INLINE Doubles exact_power(Doubles c, Doubles e) {
  constexpr int kNearest = 8;  // imm8: no scale, to the nearest whole number, no exceptions
  // c = 0 counts as the least number of a double, whose powers are 0 as floats
  const Doubles n{hn::Vec<DD>{_mm512_getexp_pd(max(c * Doubles(0.75), Doubles(1e-300)).raw.raw)}};
  const Doubles t =
      Doubles(hn::Vec<DD>{_mm512_scalef_pd(c.raw.raw, (Doubles(-1.0) - n).raw.raw)}) - Doubles(1.0);
  const Doubles whole_up = n + Doubles(1.0);
  const Doubles y = max(e * mul_add(polynomial_by_halves(t, Exact::kLog2), t, whole_up), Doubles(-1000.0));
  const Doubles f{hn::Vec<DD>{_mm512_reduce_pd(y.raw.raw, kNearest)}};
  return Doubles(
      hn::Vec<DD>{_mm512_scalef_pd(polynomial_by_halves(f, Exact::kExp2).raw.raw, (y - f).raw.raw)});
}
#else
// bits + 1 - those of 2/3 holds n above the mantissa
HWY_INLINE Doubles exact_power(Doubles c, Doubles e) {
  constexpr uint64_t kOne = 0x3ff0000000000000, kLeast = 0x3fe5555555555555, kExponent = 0xfff0000000000000;
  const DDI di;
  const auto bits = hn::BitCast(di, c.raw);
  const auto above = hn::Add(bits, word(kOne - kLeast));
  const Doubles t =
      Doubles(hn::BitCast(DD(), hn::Add(hn::Sub(bits, hn::And(above, word(kExponent))), word(kOne)))) -
      Doubles(1.0);
  // n + 1023 in the low bits of 2^52
  const auto raised = hn::Or(hn::ShiftRight<52>(above), word(0x4330000000000000));
  const Doubles n = Doubles(hn::BitCast(DD(), raised)) - Doubles(4503599627370496.0 + 1023);
  const Doubles y = max(e * mul_add(polynomial_by_halves(t, Exact::kLog2), t, n), Doubles(-1000.0));
  const Doubles magic(6755399441055744.0);  // 1.5 2^52: the whole part stays in the low bits of the sum
  const Doubles shifted = y + magic;
  const Doubles f = y - (shifted - magic);
  const auto whole = hn::ShiftLeft<52>(hn::BitCast(di, shifted.raw));
  return Doubles(
      hn::BitCast(DD(), hn::Add(hn::BitCast(di, polynomial_by_halves(f, Exact::kExp2).raw), whole)));
}
#endif

HWY_INLINE Lane joined(Doubles low, Doubles high) {
  const HalfD half;
  return Lane(hn::Combine(D(), hn::DemoteTo(half, high.raw), hn::DemoteTo(half, low.raw)));
}
HWY_INLINE Doubles low_half(Lane x) {
  return Doubles(hn::PromoteTo(DD(), hn::LowerHalf(HalfD(), x.raw)));
}
HWY_INLINE Doubles high_half(Lane x) {
  return Doubles(hn::PromoteTo(DD(), hn::UpperHalf(HalfD(), x.raw)));
}

struct ExactSpan {
  Doubles e;
  HWY_INLINE explicit ExactSpan(double exponent) : e(exponent) {}
};
HWY_INLINE Lane exact_of_span(Lane c, const ExactSpan& k) {
  return joined(exact_power(low_half(c), k.e), exact_power(high_half(c), k.e));
}
template <class Form>
HWY_INLINE Lane exact_kernel(Lane c, Lane e) {
  return joined(exact_power(low_half(c), low_half(e)), exact_power(high_half(c), high_half(e)));
}
#else  // no vectors of doubles, or none of two halves
struct ExactSpan {
  double e;
  HWY_INLINE explicit ExactSpan(double exponent) : e(exponent) {}
};
HWY_INLINE Lane exact_of_span(Lane c, const ExactSpan& k) {
  float cosines[hn::MaxLanes(D())];
  hn::StoreU(c.raw, D(), cosines);
  for (float& x : cosines) x = static_cast<float>(std::pow(static_cast<double>(x), k.e));
  return Lane(hn::LoadU(D(), cosines));
}
template <class Form>
HWY_INLINE Lane exact_kernel(Lane c, Lane e) {
  float cosines[hn::MaxLanes(D())], exponents[hn::MaxLanes(D())];
  hn::StoreU(c.raw, D(), cosines);
  hn::StoreU(e.raw, D(), exponents);
  for (std::size_t i = 0; i < hn::MaxLanes(D()); ++i)
    cosines[i] =
        static_cast<float>(std::pow(static_cast<double>(cosines[i]), static_cast<double>(exponents[i])));
  return Lane(hn::LoadU(D(), cosines));
}
#endif

HWY_INLINE Lane short_exp2(Lane x) {
  const auto [whole, f] = round_to_whole(max(x, Lane(NearExact::kMinPower)));
  return scale_by_power_of_two(NearExact::exp2_near_zero_short(f), whole);
}

// Returns (1 - V)^((e - 1) / 2), e = 1/V, by the near-exact power.
HWY_INLINE Lane power_at_inflection(Lane inverse) {
  const Lane k = (Lane(1.0) / inverse - Lane(1.0)) * Lane(0.5);
  return NearExact::value(Cosine<Lane>{Lane(1.0) - inverse, inverse}, &k);
}

// A cosine that is a given float, not computed with rounding.
struct GivenCosine : Cosine<Lane> {};
HWY_INLINE GivenCosine cosine(Lane c) {
  return {{c, Lane(1.0) - c}};
}
// From k = 1/2 on 1 - k is exact, so a fused k c + (1 - k) rounds once, as 1 - k u does, and u is not needed.
HWY_INLINE Lane falling_line(Lane k, const GivenCosine& p) {
#if HWY_NATIVE_FMA
  return mul_add(k, p.c, Lane(1.0) - k);
#else
  return neg_mul_add(k, p.u, Lane(1.0));
#endif
}
HWY_INLINE Lane squared_angle(const Cosine<Lane>& p) {
  const Lane gamma(hn::Acos(D(), p.c.raw));
  return gamma * gamma;
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
