// SPDX-License-Identifier: Apache-2.0
// Per-target include: the formulas of visible_half-inl.h over vectors of floats.
#if defined(BURNISH_EVAL_SAMPLER_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_SAMPLER_LANES_INL_H_
#undef BURNISH_EVAL_SAMPLER_LANES_INL_H_
#else
#define BURNISH_EVAL_SAMPLER_LANES_INL_H_
#endif

#include <burnish/math/highway-inl.h>

#include <burnish/eval/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

using Reals = Lane;
struct Ints {
  hn::Vec<DI> raw;

  Ints() = default;
  HWY_INLINE explicit Ints(int x) : raw(hn::Set(DI(), x)) {}
  HWY_INLINE explicit Ints(hn::Vec<DI> v) : raw(v) {}
};

HWY_INLINE Reals copy_sign(Reals size, Reals sign) {
  return Reals(hn::CopySign(size.raw, sign.raw));
}
HWY_INLINE Ints operator+(Ints a, Ints b) {
  return Ints(hn::Add(a.raw, b.raw));
}
HWY_INLINE Ints operator-(Ints a, Ints b) {
  return Ints(hn::Sub(a.raw, b.raw));
}
HWY_INLINE Ints operator*(Ints a, Ints b) {
  return Ints(hn::Mul(a.raw, b.raw));
}
HWY_INLINE Ints min(Ints a, Ints b) {
  return Ints(hn::Min(a.raw, b.raw));
}
HWY_INLINE Ints max(Ints a, Ints b) {
  return Ints(hn::Max(a.raw, b.raw));
}
HWY_INLINE hn::Mask<D> less_or_equal(Reals a, Reals b) {
  return hn::Le(a.raw, b.raw);
}
HWY_INLINE Reals if_true(hn::Mask<D> mask, Reals a, Reals b) {
  return Reals(hn::IfThenElse(mask, a.raw, b.raw));
}
HWY_INLINE Ints if_true(hn::Mask<D> mask, Ints a, Ints b) {
  return Ints(hn::IfThenElse(hn::RebindMask(DI(), mask), a.raw, b.raw));
}
HWY_INLINE Ints to_int(Reals a) {
  return Ints(hn::ConvertTo(DI(), a.raw));
}
HWY_INLINE Reals to_real(Ints a) {
  return Reals(hn::ConvertTo(D(), a.raw));
}
/// Returns a + 1, or 0 for a == last.
HWY_INLINE Ints next_around(Ints a, int last) {
  const auto next = hn::Add(a.raw, hn::Set(DI(), 1));
  return Ints(hn::IfThenElseZero(hn::Lt(a.raw, hn::Set(DI(), last)), next));
}

// Gathers entries i and i + 1 into the halves of 32 bits.
HWY_INLINE hn::Vec<DI> gather_two(const std::uint16_t* table, Ints i) {
  return hn::GatherOffset(DI(), reinterpret_cast<const std::int32_t*>(table), hn::Add(i.raw, i.raw));
}
struct EdgePairs {
  Ints lower, mass;
};
HWY_INLINE EdgePairs edge_pair(const std::uint16_t* table, Ints i) {
  const DI di;
  const auto two = gather_two(table, i), low = hn::Set(di, 0xffff);
  const auto high = hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(hn::RebindToUnsigned<D>(), two)));
  return {Ints(hn::And(two, low)), Ints(hn::And(hn::Sub(high, two), low))};
}

// Searches by halves: each step reads one edge a lane.
template <int kSlices>
HWY_INLINE Ints search(const std::uint16_t* table, const Ints (&start)[kSlices],
                       const Reals (&weight)[kSlices], int count, Reals target) {
  const DI di;
  const auto low = hn::Set(di, 0xffff);
  auto index = hn::Zero(di);
  for (int step = count / 2; step > 0; step /= 2) {
    const auto next = hn::Add(index, hn::Set(di, step));
    Reals edge(0.0);
    for (int s = 0; s < kSlices; ++s)
      edge = edge + weight[s] * to_real(Ints(hn::And(gather_two(table, start[s] + Ints(next)), low)));
    index = hn::IfThenElse(hn::RebindMask(di, less_or_equal(edge, target)), next, index);
  }
  return Ints(index);
}

#define SAMPLER_INLINE HWY_INLINE
#include <burnish/eval/visible_half-inl.h>
#undef SAMPLER_INLINE

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
