// SPDX-License-Identifier: Apache-2.0
// Per-target include: (bi)linear interpolation of tables for a vector of positions. Intrinsics stay here.
#if defined(BURNISH_EVAL_LOOKUP_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_LOOKUP_LANES_INL_H_
#undef BURNISH_EVAL_LOOKUP_LANES_INL_H_
#else
#define BURNISH_EVAL_LOOKUP_LANES_INL_H_
#endif

#include <cstdint>

#include <hwy/contrib/math/math-inl.h>

#include <burnish/eval/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

constexpr std::size_t kLanes = hn::MaxLanes(D());

/// The cell of a position >= 0, and how far in it the position is. An integer position is the start of its cell or
/// the end of the one before.
template <class Tag>
struct LaneCellOf {
  LaneOf<Tag> shifted;   // 1.5 2^23 + node: the node in the low 22 bits
  LaneOf<Tag> fraction;  // 0 to 1
};
using LaneCell = LaneCellOf<D>;
template <class Tag>
HWY_INLINE LaneCellOf<Tag> cell_of(LaneOf<Tag> position) {
  // Adding 1.5 2^23 rounds position - 1/2 to a whole number, the node; subtracting it again gives the node as a
  // float.
  const LaneOf<Tag> magic(kRoundingShift);
  const LaneOf<Tag> shifted = (position - LaneOf<Tag>(0.5)) + magic;
  return {shifted, position - (shifted - magic)};
}
template <class Tag>
HWY_INLINE hn::Vec<hn::RebindToSigned<Tag>> node_of(const LaneCellOf<Tag>& cell) {
  const hn::RebindToSigned<Tag> di;
  return hn::And(hn::BitCast(di, cell.shifted.raw), hn::Set(di, 0x3fffff));
}

#define FORMULA_INLINE HWY_INLINE
#include <burnish/factors/lookup-inl.h>
#undef FORMULA_INLINE

#undef BURNISH_PLANES_IN_REGISTERS
#if BURNISH_TARGET_IS_AVX3
#define BURNISH_PLANES_IN_REGISTERS 1

/// A line of up to 16 kVectors nodes held in registers: no memory is read a lookup.
template <int kVectors>
struct Plane {
  hn::Vec<D> part[kVectors];

  HWY_INLINE void load(const float* from) {
    for (int i = 0; i < kVectors; ++i) part[i] = hn::LoadU(D(), from + 16 * i);
  }
  // The permutation takes the low four or five bits of a node; the bits above choose between its results.
  HWY_INLINE Lane at(hn::Vec<DI> node) const {
    if constexpr (kVectors == 1)
      return Lane(hn::Vec<D>{_mm512_permutexvar_ps(node.raw, part[0].raw)});
    else
      return of_first<kVectors>(node, 0);
  }
  template <int kCount>
  HWY_INLINE Lane of_first(hn::Vec<DI> node, int first) const {
    if constexpr (kCount == 2) {
      return Lane(hn::Vec<D>{_mm512_permutex2var_ps(part[first].raw, node.raw, part[first + 1].raw)});
    } else {
      const auto upper = hn::RebindMask(D(), hn::TestBit(node, hn::Set(DI(), 8 * kCount)));
      return Lane(hn::IfThenElse(upper, of_first<kCount / 2>(node, first + kCount / 2).raw,
                                 of_first<kCount / 2>(node, first).raw));
    }
  }
};
#else
#define BURNISH_PLANES_IN_REGISTERS 0
#endif

/// Four floats: a node's channels.
#if HWY_TARGET == HWY_SCALAR
struct Quad {
  float c[4];
};
HWY_INLINE Quad load_quad(const float* from) {
  return {{from[0], from[1], from[2], from[3]}};
}
HWY_INLINE void store(Quad q, float* to) {
  for (int i = 0; i < 4; ++i) to[i] = q.c[i];
}
HWY_INLINE Quad operator*(Quad a, Quad b) {
  for (int i = 0; i < 4; ++i) a.c[i] *= b.c[i];
  return a;
}
HWY_INLINE Quad mix(Quad low, Quad high, float fraction) {
  for (int i = 0; i < 4; ++i) low.c[i] += fraction * (high.c[i] - low.c[i]);
  return low;
}
#else
using D4 = hn::CappedTag<float, 4>;
using D2 = hn::Half<D4>;
using Four = LaneOf<D4>;
struct Quad {
  hn::Vec<D4> raw;
};
HWY_INLINE Quad load_quad(const float* from) {
  return {hn::LoadU(D4(), from)};
}
HWY_INLINE void store(Quad q, float* to) {
  hn::StoreU(q.raw, D4(), to);
}
HWY_INLINE Quad operator*(Quad a, Quad b) {
  return {hn::Mul(a.raw, b.raw)};
}
HWY_INLINE Quad mix(Quad low, Quad high, float fraction) {
  return {hn::MulAdd(hn::Set(D4(), fraction), hn::Sub(high.raw, low.raw), low.raw)};
}
#endif

/// Interpolates linearly between two nodes of four floats.
HWY_INLINE Quad interpolate(const float* node, float fraction) {
  return mix(load_quad(node), load_quad(node + 4), fraction);
}
/// Interpolates bilinearly between four nodes. Two nodes of a row fit one vector of eight floats.
HWY_INLINE Quad interpolate(const float* node, const float* above, float fraction_x, float fraction_y) {
#if HWY_MAX_BYTES >= 32
  const hn::CappedTag<float, 8> d8;
  const auto low = hn::LoadU(d8, node), high = hn::LoadU(d8, above);
  const auto both = hn::MulAdd(hn::Set(d8, fraction_y), hn::Sub(high, low), low);
  return mix(Quad{hn::LowerHalf(D4(), both)}, Quad{hn::UpperHalf(D4(), both)}, fraction_x);
#else
  return mix(interpolate(node, fraction_x), interpolate(above, fraction_x), fraction_y);
#endif
}

/// Interpolates trilinearly between eight nodes: four of a layer, and four of the next.
HWY_INLINE Quad interpolate(const float* node, const float* above, std::size_t layer, float fraction_x,
                            float fraction_y, float fraction_z) {
#if HWY_MAX_BYTES >= 32
  const hn::CappedTag<float, 8> d8;
  const auto between =
      [&](hn::Vec<hn::CappedTag<float, 8>> low, hn::Vec<hn::CappedTag<float, 8>> high, float fraction)
          HWY_ATTR { return hn::MulAdd(hn::Set(d8, fraction), hn::Sub(high, low), low); };
  const auto along = [&](const float* row) HWY_ATTR {
    return between(hn::LoadU(d8, row), hn::LoadU(d8, row + layer), fraction_z);
  };
  const auto both = between(along(node), along(above), fraction_y);
  return mix(Quad{hn::LowerHalf(D4(), both)}, Quad{hn::UpperHalf(D4(), both)}, fraction_x);
#else
  return mix(interpolate(node, above, fraction_x, fraction_y),
             interpolate(node + layer, above + layer, fraction_x, fraction_y), fraction_z);
#endif
}

#if BURNISH_TARGET_IS_AVX3
/// Loads two nodes from each of two places.
HWY_INLINE Lane load_nodes(const float* node, const float* other) {
  const hn::Half<D> d8;
  return Lane(hn::Combine(D(), hn::LoadU(d8, other), hn::LoadU(d8, node)));
}
/// Returns the first nodes of four places, which stand two in a vector; second_nodes() returns the second ones.
HWY_INLINE Lane first_nodes(Lane two, Lane others) {
  return Lane(hn::Vec<D>{_mm512_shuffle_f32x4(two.raw.raw, others.raw.raw, 0x88)});
}
HWY_INLINE Lane second_nodes(Lane two, Lane others) {
  return Lane(hn::Vec<D>{_mm512_shuffle_f32x4(two.raw.raw, others.raw.raw, 0xdd)});
}
#endif

#if HWY_TARGET != HWY_SCALAR
/// Returns the first, second and third floats of each of kLanes quads; quad j is the j / 4-th of part[j % 4].
HWY_INLINE void transpose(const Lane (&part)[4], Lane (&channel)[3]) {
  const D d;
  const hn::Repartition<std::uint64_t, D> pairs;
  const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(d, part[0].raw, part[1].raw));
  const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(d, part[2].raw, part[3].raw));
  const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(d, part[0].raw, part[1].raw));
  const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(d, part[2].raw, part[3].raw));
  channel[0] = Lane(hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23)));
  channel[1] = Lane(hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23)));
  channel[2] = Lane(hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23)));
}
#endif

/// Transposes quads in memory; quad j is at k kLanes + 4 (j / 4), k = j % 4.
HWY_INLINE void transpose(const float* buffer, Lane (&channel)[3]) {
#if HWY_TARGET == HWY_SCALAR
  for (int c = 0; c < 3; ++c) channel[c] = load(buffer + c);
#else
  const Lane part[] = {load(buffer), load(buffer + kLanes), load(buffer + 2 * kLanes),
                       load(buffer + 3 * kLanes)};
  transpose(part, channel);
#endif
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
