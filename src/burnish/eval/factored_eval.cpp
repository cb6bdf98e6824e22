// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/eval/factored_eval.h>
#include <burnish/eval/factored_plan.h>
#include <burnish/eval/lobe_evaluator.h>

// This file is compiled without contraction to fused multiply-adds (CMakeLists.txt). A fused a * x + b * y differs
// from b * y + a * x, so swapping the directions would change the last bit. Where contraction cannot be switched off,
// fused multiply-adds are written out.

#define HWY_TARGET_INCLUDE "burnish/eval/factored_eval.cpp"
#include <burnish/math/highway-inl.h>

#include <burnish/eval/lookup_lanes-inl.h>
#include <burnish/eval/one_pair_lanes-inl.h>
#include <burnish/eval/projection_lanes-inl.h>
#include <burnish/eval/volume_lanes-inl.h>

#ifndef BURNISH_EVAL_FACTORED_ARGUMENTS
#define BURNISH_EVAL_FACTORED_ARGUMENTS
namespace burnish {
// wi_x, wi_y, wi_z, wo_x, wo_y, wo_z of a direction every `step` floats: 1 in planes, 3 in rows.
struct DirectionPointers {
  const float* component[6];
  std::size_t step = 1;

  const float* at(std::size_t k, std::size_t i) const { return component[k] + i * step; }
};

// Channel c of direction i is written to f[c * plane + i * step]; step is 1 or the number of channels.
struct ValuePointers {
  float* f;
  std::size_t plane, step;

  float* at(std::size_t channel, std::size_t i) const { return f + channel * plane + i * step; }
  ValuePointers from(std::size_t channel, std::size_t i) const { return {at(channel, i), plane, step}; }
};

constexpr std::size_t kCacheLine = 16;  // floats
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

constexpr std::size_t kMaxBlock = FactoredPlan::kMaxBlock;

// Returns the larger deviation of a pair's directions from unit length.
HWY_INLINE hn::Vec<DI> excess(const Lane (&w)[6]) {
  return hn::Max(excess_of(w[0], w[1], w[2]), excess_of(w[3], w[4], w[5]));
}

// Turns a block of directions into positions in tables. Every step is a loop of its own and takes no branch; stores
// are hidden behind roots and divisions. The formulas are those of projection-inl.h.
struct Projector {
  alignas(64) float sum_x[kMaxBlock], sum_y[kMaxBlock], sum_z[kMaxBlock],
      sum_length[kMaxBlock];                   // wi + wo
  alignas(64) float directions[6][kMaxBlock];  // components of directions that came in rows
  // The current projection: (x, y), its length r, and den with r / den = tan(theta / 2).
  alignas(64) float own_x[kMaxBlock], own_y[kMaxBlock], r[kMaxBlock], den[kMaxBlock];
  alignas(64) float power[kMaxBlock];  // powers of tan(theta / 2)
  const float* in[6];                  // planes of wi and wo
  const float *x, *y;
  std::size_t count;
  bool all_directions;

  template <class Step>
  HWY_INLINE void for_each(const Step& step) const {
    for (std::size_t i = 0; i < count; i += kLanes) step(i);
  }

  // Splits rows into planes, adds the two directions, and checks that they are unit vectors: all while roots are
  // taken.
  template <bool kRows, bool kSum>
  void begin() {
    const float *const wi = in[0], *const wo = in[3];
    if constexpr (kRows)
      for (std::size_t k = 0; k < 6; ++k) in[k] = directions[k];
    auto worst = hn::Zero(DI());
    for_each([&](std::size_t i) HWY_ATTR {
      Lane w[6];
      if constexpr (kRows) {
        hn::LoadInterleaved3(D(), wi + 3 * i, w[0].raw, w[1].raw, w[2].raw);
        hn::LoadInterleaved3(D(), wo + 3 * i, w[3].raw, w[4].raw, w[5].raw);
        for (int k = 0; k < 6; ++k) store(w[k], directions[k] + i);
        for (std::size_t k = 3 * i; k < 3 * (i + kLanes); k += kCacheLine) {  // for the next block
          hwy::Prefetch(wi + 3 * kMaxBlock + k);
          hwy::Prefetch(wo + 3 * kMaxBlock + k);
        }
      } else {
        for (std::size_t k = 0; k < 6; ++k) w[k] = load(in[k] + i);
      }
      // The largest deviation from unit length is kept, and tested once a block.
      worst = hn::Max(worst, excess(w));
      if constexpr (kSum) {
        // wi + wo is the unnormalized half vector; its length is 2 cos(theta_d).
        const Lane u = w[0] + w[3], v = w[1] + w[4], z = w[2] + w[5];
        store(u, sum_x + i);
        store(v, sum_y + i);
        store(z, sum_z + i);
        store(length(u, v, z), sum_length + i);
      }
    });
    // One test serves the block: almost always, all directions are unit vectors.
    all_directions = hn::AllFalse(DI(), no_directions(worst));
  }

  void begin(const DirectionPointers& from, std::size_t first, std::size_t number, bool sum) {
    count = number;
    for (std::size_t k = 0; k < 6; ++k) in[k] = from.at(k, first);
    if (from.step == 3) {
      if (sum)
        begin<true, true>();
      else
        begin<true, false>();
    } else {
      if (sum)
        begin<false, true>();
      else
        begin<false, false>();
    }
  }

  HWY_INLINE Lanes direction(std::size_t first, std::size_t i) const {
    return {load(in[first] + i), load(in[first + 1] + i), load(in[first + 2] + i)};
  }
  HWY_INLINE LanePairOf<D> pair(std::size_t i) const {
    return {{load(sum_x + i), load(sum_y + i), load(sum_z + i)},
            direction(0, i) - direction(3, i),
            load(sum_length + i)};
  }
  HWY_INLINE void put(const Polar<Lane>& polar, std::size_t i) {
    store(polar.r, r + i);
    store(polar.den, den + i);
  }

  // Projects a vector (x, y, z) of length `total`, or of unit length if that is null.
  void project_up(const float* from_x, const float* from_y, const float* z, const float* total, bool radius) {
    x = from_x;
    y = from_y;
    const auto polar = [=](std::size_t i) HWY_ATTR {
      return polar_of(Lanes{load(from_x + i), load(from_y + i), load(z + i)},
                      total ? load(total + i) : Lane(1.0));
    };
    // Only positions that need the radius pay for its root: an identity-warped disk needs (x, y) / den alone.
    if (radius)
      for_each([&](std::size_t i) HWY_ATTR { put(polar(i), i); });
    else
      for_each([&](std::size_t i) HWY_ATTR { store(polar(i).den, den + i); });
  }

  // Finds tan(theta / 2) = r / den of a projection that has a polar angle but no azimuth.
  void project_angle(Projection::Kind kind) {
    with_angle(kind, [&](const auto& angle)
                         HWY_ATTR { for_each([&](std::size_t i) HWY_ATTR { put(angle(pair(i)), i); }); });
  }

  // Projects onto 2 d, the doubled difference vector, whose z is |wi + wo|.
  void project_difference() {
    x = own_x;
    y = own_y;
    for_each([&](std::size_t i) HWY_ATTR {
      const auto [d, polar] = doubled_difference(pair(i));
      store(d.x, own_x + i);
      store(d.y, own_y + i);
      put(polar, i);
    });
  }

  // Projects onto an affine combination of wi, wo, the mirrored wi and the normal, of any length.
  void project_affine(const Projection& p) {
    x = own_x;
    y = own_y;
    for_each([&](std::size_t i) HWY_ATTR {
      const auto [v, polar] = affine(p, direction(0, i), direction(3, i));
      store(v.x, own_x + i);
      store(v.y, own_y + i);
      put(polar, i);
    });
  }

  void project(const FactoredPlan::Source& source) {
    using Kind = FactoredPlan::Source::Kind;
    switch (source.kind) {
      case Kind::wi:
        return project_up(in[0], in[1], in[2], nullptr, source.radius);
      case Kind::wo:
        return project_up(in[3], in[4], in[5], nullptr, source.radius);
      case Kind::half:
        return project_up(sum_x, sum_y, sum_z, sum_length, source.radius);
      case Kind::affine:
        return project_affine(source.projection);
      case Kind::difference:
        return project_difference();
      case Kind::angle:
        return project_angle(source.projection.kind);
    }
  }

  HWY_INLINE Polar<Lane> polar(std::size_t i) const { return {load(r + i), load(den + i)}; }

  // Stores positions in cells: `warp` maps a polar angle to a line's position, `stretch` gives the factor of a disk's
  // x and y. Positions are clamped to the table.
  template <class WarpOf, class StretchOf>
  HWY_INLINE void place(const FactoredPlan::Position& k, float* to, std::size_t stride, const WarpOf& warp,
                        const StretchOf& stretch) const {
    const Lane cells(k.cells), centre(0.5 * k.cells);
    if (k.disk)
      for_each([&](std::size_t i) HWY_ATTR {
        // A disk's position is its middle plus (x, y) times the stretch.
        const Lane scale = stretch(polar(i));
        store(within(mul_add(load(x + i), scale, centre), cells), to + i);
        store(within(mul_add(load(y + i), scale, centre), cells), to + stride + i);
      });
    else
      for_each([&](std::size_t i) HWY_ATTR { store(within(warp(polar(i)), cells), to + i); });
  }
  // Places by a power warp. Lines of several sizes share one power: it is found for size 1, which leaves every bit of
  // the product as it would be.
  template <class Exponent>
  HWY_INLINE void place_by_power(const FactoredPlan::Position& k, float* to, std::size_t stride,
                                 const Exponent& exponent) {
    const Lane size(k.size), cells(k.cells);
    if (k.disk)
      return place(
          k, to, stride, [&](const Polar<Lane>& p) HWY_ATTR { return power_warp(size, exponent, p); },
          [&](const Polar<Lane>& p) HWY_ATTR { return power_stretch(size, exponent, p); });
    // The power of tan(theta / 2) stays for the next line that shares it.
    if (!k.shares_power)
      for_each([&](std::size_t i) HWY_ATTR { store(power_warp(Lane(1.0), exponent, polar(i)), power + i); });
    for_each([&](std::size_t i) HWY_ATTR { store(within(size * load(power + i), cells), to + i); });
  }

  void find_positions(const FactoredPlan::Position& k, float* to, std::size_t stride) {
    // Each kind of warp has a loop of its own; a power of 1/2 is a root.
    const Lane size(k.size), parameter(k.parameter);
    switch (k.warp) {
      case WarpKind::identity:
        return place(
            k, to, stride, [&](const Polar<Lane>& p) HWY_ATTR { return identity_warp(size, p); },
            [&](const Polar<Lane>& p) HWY_ATTR { return identity_stretch(size, p); });
      case WarpKind::rational:
        return place(
            k, to, stride, [&](const Polar<Lane>& p) HWY_ATTR { return rational_warp(size, parameter, p); },
            [&](const Polar<Lane>& p) HWY_ATTR { return rational_stretch(size, parameter, p); });
      case WarpKind::power:
        return k.parameter == 0.5f ? place_by_power(k, to, stride, Half())
                                   : place_by_power(k, to, stride, parameter);
    }
  }
};

// Lookups in rows. Loops are separate, because loads that span several recent stores would wait for them.
struct RowCells {
  alignas(64) std::int32_t first[kMaxBlock];  // index of the first float of a lookup
  alignas(64) float x[kMaxBlock], y[kMaxBlock], z[kMaxBlock];

  /// Splits positions into nodes and fractions. at[k] holds the positions along axis k.
  template <int kAxes>
  HWY_INLINE void find(const FactoredPlan::Lookup& lookup, const std::array<const float*, 3>& at,
                       std::size_t count) {
    const DI di;
    const auto width = hn::Set(di, static_cast<std::int32_t>(lookup.width));
    const auto layer = hn::Set(di, static_cast<std::int32_t>(lookup.layer));
    for (std::size_t i = 0; i < count; i += kLanes) {
      // node = x + width y + layer z, and a node has kRowStride floats.
      const LaneCell across = cell_of(load(at[0] + i));
      hn::Vec<DI> node = node_of(across);
      if constexpr (kAxes > 1) {
        const LaneCell up = cell_of(load(at[1] + i));
        node = hn::Add(node, hn::Mul(node_of(up), width));
        store(up.fraction, y + i);
      }
      if constexpr (kAxes > 2) {
        const LaneCell inwards = cell_of(load(at[2] + i));
        node = hn::Add(node, hn::Mul(node_of(inwards), layer));
        store(inwards.fraction, z + i);
      }
      static_assert(FactoredPlan::kRowStride == 4);
      hn::StoreU(hn::ShiftLeft<2>(node), di, first + i);
      store(across.fraction, x + i);
    }
  }
  /// Interpolates direction i linearly along all axes. above, layer: floats to the next row, and to the next layer.
  template <int kAxes>
  HWY_INLINE Quad interpolated(const float* table, std::size_t above, std::size_t layer,
                               std::size_t i) const {
    const float* const node = table + first[i];
    if constexpr (kAxes == 1) return interpolate(node, x[i]);
    if constexpr (kAxes == 2) return interpolate(node, node + above, x[i], y[i]);
    if constexpr (kAxes == 3) return interpolate(node, node + above, layer, x[i], y[i], z[i]);
  }
};
struct Rows {
  RowCells cells, pair_cells;
  alignas(64) float values[FactoredPlan::kRowStride * kMaxBlock];
};

// Calls store_quad(i, where) for at least `count` directions of a block, in fours, with the places in `values` that
// transpose() expects.
template <class StoreQuad>
HWY_INLINE void for_each_quad(std::size_t count, float* values, const StoreQuad& store_quad) {
  constexpr std::size_t kFours = kLanes < 4 ? 1 : 4;
  for (std::size_t i = 0; i < count; i += kLanes)
    for (std::size_t four = 0; four < kLanes && i + four < count; four += kFours)
      for (std::size_t k = 0; k < kFours; ++k) store_quad(i + four + k, values + 4 * i + k * kLanes + four);
}

// The running product of a lobe's lookups. It begins with the scale, and each lookup multiplies it.
struct Block {
  std::size_t stride, count;
  const float* positions;  // `stride` floats for each slot
  float* values;           // kMaxBlock floats for each channel
  const float* before;     // laid out as `values`, or kLanes floats of the scale for each channel
  std::size_t before_stride, before_mask;
  Rows& rows;

  HWY_INLINE const float* slot(std::size_t s) const { return positions + s * stride; }
  HWY_INLINE std::array<const float*, 3> slots(const std::array<std::size_t, 3>& s) const {
    return {slot(s[0]), slot(s[1]), slot(s[2])};
  }
  HWY_INLINE void multiply(std::size_t channel, std::size_t i, Lane factor) const {
    store(load(before + channel * before_stride + (i & before_mask)) * factor,
          values + channel * kMaxBlock + i);
  }
};

using Multiply = void (*)(const FactoredPlan::Lookup& lookup, const float* table, const Block& block);

#if BURNISH_PLANES_IN_REGISTERS
template <int kVectors, int kChannels, bool kShared>
void multiply_planes(const FactoredPlan::Lookup& lookup, const float* table, const Block& block) {
  // A short line fits in registers, so a lookup is a permutation and reads no memory.
  constexpr int kPlanes = kShared ? 1 : kChannels;
  Plane<kVectors> planes[kPlanes];
  for (int c = 0; c < kPlanes; ++c) planes[c].load(table + static_cast<std::size_t>(16 * kVectors * c));
  const float *const x = block.slot(lookup.at[0]), *const pair_x = block.slot(lookup.pair_at[0]);
  const auto interpolate = [&](const float* position, Lane(&value)[kPlanes]) HWY_ATTR {
    const LaneCell cell = cell_of(load(position));
    const hn::Vec<DI> node = hn::BitCast(DI(), cell.shifted.raw), next = hn::Add(node, hn::Set(DI(), 1));
    for (int c = 0; c < kPlanes; ++c) value[c] = mix(planes[c].at(node), planes[c].at(next), cell.fraction);
  };
  for (std::size_t i = 0; i < block.count; i += kLanes) {
    // A pair of lookups that swapping wi and wo exchanges is multiplied first: the product is the same either way
    // round.
    Lane value[kPlanes];
    interpolate(x + i, value);
    if (lookup.pair) {
      Lane other[kPlanes];
      interpolate(pair_x + i, other);
      for (int c = 0; c < kPlanes; ++c) value[c] = value[c] * other[c];
    }
    for (int c = 0; c < kChannels; ++c)
      block.multiply(static_cast<std::size_t>(c), i, value[kShared ? 0 : c]);
  }
}

template <int kVectors>
Multiply planes_kernel(bool shared, std::size_t channels) {
  if (channels == 1) return &multiply_planes<kVectors, 1, true>;
  return shared ? &multiply_planes<kVectors, 3, true> : &multiply_planes<kVectors, 3, false>;
}
Multiply planes_kernel(std::size_t vectors, bool shared, std::size_t channels) {
  return vectors == 1   ? planes_kernel<1>(shared, channels)
         : vectors == 2 ? planes_kernel<2>(shared, channels)
         : vectors == 4 ? planes_kernel<4>(shared, channels)
                        : planes_kernel<8>(shared, channels);
}
#endif

template <int kChannels, int kAxes>
void multiply_rows(const FactoredPlan::Lookup& lookup, const float* table, const Block& block) {
  // Interpolation takes one direction at a time with its channels as lanes; transpose() then makes directions the
  // lanes.
  Rows& rows = block.rows;
  const std::size_t above = lookup.width * FactoredPlan::kRowStride,
                    layer = lookup.layer * FactoredPlan::kRowStride;
  const std::size_t count = block.count;
  rows.cells.find<kAxes>(lookup, block.slots(lookup.at), count);
  if (lookup.pair) {
    rows.pair_cells.find<kAxes>(lookup, block.slots(lookup.pair_at), count);
    for_each_quad(count, rows.values, [&](std::size_t i, float* to) HWY_ATTR {
      store(rows.cells.interpolated<kAxes>(table, above, layer, i) *
                rows.pair_cells.interpolated<kAxes>(table, above, layer, i),
            to);
    });
  } else {
    for_each_quad(count, rows.values, [&](std::size_t i, float* to) HWY_ATTR {
      store(rows.cells.interpolated<kAxes>(table, above, layer, i), to);
    });
  }
  for (std::size_t i = 0; i < count; i += kLanes) {
    Lane value[kTogether];
    // Four channels a direction become one vector a channel, which multiplies the product.
    transpose(rows.values + i * FactoredPlan::kRowStride, value);
    for (std::size_t c = 0; c < kChannels; ++c) block.multiply(c, i, value[c]);
  }
}

template <int kChannels>
void multiply(const FactoredPlan& plan, const FactoredPlan::Lookup& lookup, std::size_t group,
              const Block& block) {
#if BURNISH_PLANES_IN_REGISTERS
  if (lookup.plane_vectors > 0) {
    const std::size_t plane = lookup.shared ? 0 : group * kTogether * lookup.plane_vectors * 16;
    // Short lines are read from registers where the processor permutes vectors; all else from rows in memory.
    planes_kernel(lookup.plane_vectors, lookup.shared, kChannels)(
        lookup, plan.values.data() + lookup.planes + plane, block);
    return;
  }
#endif
  const float* const rows = plan.values.data() + lookup.rows + group * lookup.next_group;
  switch (lookup.axes) {
    case 1:
      return multiply_rows<kChannels, 1>(lookup, rows, block);
    case 2:
      return multiply_rows<kChannels, 2>(lookup, rows, block);
    default:
      return multiply_rows<kChannels, 3>(lookup, rows, block);
  }
}

struct Scratch {
  alignas(64) float positions[FactoredPlan::kMaxSlots * kLanes];
  alignas(64) float sum[kTogether * kMaxBlock];
  alignas(64) float product[kTogether * kMaxBlock];
  alignas(64) float scale[kTogether * kLanes];
  Projector projector;
  VolumePipeline volumes;
  Rows rows;
};

// Stores the values that finish(i, value) computes for each vector of directions: the first `stored` channels go to
// `to`. Planes and interleaved triples have fast ways; the rest goes number by number.
template <int kChannels, class Finish>
HWY_INLINE void store_values(std::size_t count, std::size_t stored, const ValuePointers& to,
                             const Finish& finish) {
  Lane value[kChannels];
  std::size_t i = 0;
  if (to.step == 1) {
    for (; i + kLanes <= count; i += kLanes) {
      finish(i, value);
      for (std::size_t c = 0; c < stored; ++c) {
        store(value[c], to.at(c, i));
        hwy::Prefetch(to.at(c, i) + kMaxBlock);  // for the next block
      }
    }
  } else if (kChannels == 3 && to.step == 3) {
    for (; i + kLanes <= count; i += kLanes) {
      finish(i, value);
      hn::StoreInterleaved3(value[0].raw, value[1 % kChannels].raw, value[2 % kChannels].raw, D(),
                            to.at(0, i));
    }
  }
  for (; i < count; i += kLanes) {
    finish(i, value);
    for (std::size_t c = 0; c < stored; ++c) {
      float lanes[kLanes];
      store(value[c], lanes);
      for (std::size_t k = i; k < std::min(count, i + kLanes); ++k) *to.at(c, k) = lanes[k - i];
    }
  }
}

// Evaluates one group of channels for the projector's directions. With kApart, each lobe gives its own values, and
// its channels follow those of the lobe before; else the lobes are summed.
template <int kChannels, bool kApart>
void eval_group(const FactoredPlan& plan, std::size_t group, std::size_t stride, Scratch& scratch,
                const ValuePointers& out) {
  const std::size_t count = scratch.projector.count;
  // Values are stored as 0 where a direction is below the horizon.
  const float *const wi_z = scratch.projector.in[2], *const wo_z = scratch.projector.in[5];
  const std::size_t stored = std::min<std::size_t>(kChannels, plan.channels - group * kTogether);
  const auto store_sum = [&](std::size_t channel) HWY_ATTR {
    const auto finish = [&](std::size_t i, Lane(&value)[kChannels]) HWY_ATTR {
      // `lit` is wo.z where wi.z > 0, else 0: it is positive only where both directions are above the horizon.
      const Lane lit = if_positive(load(wi_z + i), load(wo_z + i));
      for (std::size_t c = 0; c < kChannels; ++c)
        value[c] = if_positive(lit, load(scratch.sum + c * kMaxBlock + i));
    };
    store_values<kChannels>(count, stored, out.from(channel, 0), finish);
  };

  for (const FactoredPlan::Product& product : plan.products) {
    const auto lobe = static_cast<std::size_t>(&product - plan.products.data());
    const bool first = kApart || lobe == 0;
    for (std::size_t c = 0; c < kChannels; ++c)
      store(Lane(product.scale[group * kTogether + c]), scratch.scale + c * kLanes);
    Block block{stride, count, scratch.positions, first ? scratch.sum : scratch.product, scratch.scale,
                kLanes, 0,     scratch.rows};
    // One lobe is its scale times all lookups [HomomorphicBrdf, eq. 4].
    for (std::size_t k = product.first; k < product.last; ++k) {
      multiply<kChannels>(plan, plan.lookups[k], group, block);
      block.before = block.values;
      block.before_stride = kMaxBlock;
      block.before_mask = ~std::size_t{0};
    }
    for (std::size_t c = 0; c < kChannels; ++c)
      for (std::size_t i = 0; i < count; i += kLanes) {
        // The first lobe is its own sum; later lobes are added to it. A lobe without factors is its scale.
        if (product.first == product.last) block.multiply(c, i, Lane(1.0));
        float* const sum = scratch.sum + c * kMaxBlock + i;
        if (!first) store(load(sum) + load(scratch.product + c * kMaxBlock + i), sum);
      }
    if constexpr (kApart) store_sum(lobe * plan.channels + group * kTogether);
  }
  if constexpr (!kApart) store_sum(group * kTogether);
}

// Overwrites values with not-a-number where an argument is no pair of unit vectors.
void spoil_others(const Projector& p, std::size_t channels, const ValuePointers& out) {
  for (std::size_t i = 0; i < p.count; i += kLanes) {
    Lane w[6];
    for (std::size_t k = 0; k < 6; ++k) w[k] = load(p.in[k] + i);
    std::int32_t other[kLanes];
    hn::StoreU(hn::VecFromMask(DI(), no_directions(excess(w))), DI(), other);
    for (std::size_t k = i; k < std::min(p.count, i + kLanes); ++k)
      for (std::size_t c = 0; c < channels && other[k - i] != 0; ++c)
        *out.at(c, k) = std::numeric_limits<float>::quiet_NaN();
  }
}

// Stores the values of a volume times a line, in whole vectors.
struct VolumeValues {
  ValuePointers to;

  HWY_INLINE void operator()(std::size_t i, const Lane (&value)[kTogether]) const {
    if (to.step == 1) {
      for (std::size_t c = 0; c < kTogether; ++c) {
        store(value[c], to.at(c, i));
        hwy::Prefetch(to.at(c, i) + kMaxBlock);
      }
    } else {
      hn::StoreInterleaved3(value[0].raw, value[1].raw, value[2].raw, D(), to.at(0, i));
    }
  }
};

// Evaluates whole vectors of directions of a model that is a volume times a line.
template <bool kRows>
void eval_volumes(const FactoredPlan& plan, const DirectionPointers& in, std::size_t count,
                  VolumePipeline& pipeline, const ValuePointers& out) {
  const FactoredPlan::VolumeAndLine& v = *plan.volume_and_line;
  const float* w[6];
  for (std::size_t k = 0; k < 6; ++k) w[k] = in.at(k, 0);
  const VolumeValues put{out};
  if (v.root[0] || v.root[3])
    pipeline.run<kRows, true>(plan, w, count, put);
  else
    pipeline.run<kRows, false>(plan, w, count, put);
}

// Evaluates up to kMaxBlock directions from `first` on, in memory that whole vectors can be read from. kApart: see
// eval_group.
template <bool kApart>
void eval_block(const FactoredPlan& plan, const DirectionPointers& in, std::size_t first, std::size_t count,
                std::size_t stride, Scratch& scratch, const ValuePointers& out) {
  Projector& projector = scratch.projector;
  projector.begin(in, first, count, plan.needs_sum);
  // Every distinct projection is computed once, and every distinct position of it once.
  for (const FactoredPlan::Source& source : plan.sources) {
    projector.project(source);
    for (const FactoredPlan::Position& position : source.positions)
      projector.find_positions(position, scratch.positions + position.slot * stride, stride);
  }
  // Channels go through the lookups in groups of three, or one by itself if one is left.
  for (std::size_t group = 0; group * kTogether < plan.channels; ++group) {
    const std::size_t left = plan.channels - group * kTogether;
    if (left == 1)
      eval_group<1, kApart>(plan, group, stride, scratch, out);
    else
      eval_group<3, kApart>(plan, group, stride, scratch, out);
  }
  if (!projector.all_directions)
    spoil_others(projector, plan.channels * (kApart ? plan.products.size() : 1), out);
}

template <bool kApart>
void eval_all(const FactoredPlan& plan, const DirectionPointers& in, std::size_t count,
              const ValuePointers& out) {
  // Blocks are as long as the room for positions allows.
  Scratch scratch;
  constexpr std::size_t kPositions = FactoredPlan::kMaxSlots * kLanes;
  const std::size_t slots = std::max<std::size_t>(plan.slots, 1);
  const std::size_t stride = std::min(kMaxBlock, kPositions / slots / kLanes * kLanes);
  const std::size_t whole = count / kLanes * kLanes;
  // Models of a volume times a line have a kernel of their own.
  if (plan.volume_and_line && whole != 0) {
    if (in.step == 3)
      eval_volumes<true>(plan, in, whole, scratch.volumes, out);
    else
      eval_volumes<false>(plan, in, whole, scratch.volumes, out);
  } else {
    for (std::size_t i = 0; i < whole; i += stride)
      eval_block<kApart>(plan, in, i, std::min(stride, whole - i), stride, scratch, out.from(0, i));
  }
  if (whole == count) return;
  // The remaining directions are filled up to a vector with the first of them.
  const std::size_t left = count - whole;
  float rest[6][kLanes];
  for (std::size_t k = 0; k < 6; ++k) {
    std::fill(rest[k], rest[k] + kLanes, *in.at(k, whole));
    for (std::size_t i = 1; i < left; ++i) rest[k][i] = *in.at(k, whole + i);
  }
  const DirectionPointers filled{{rest[0], rest[1], rest[2], rest[3], rest[4], rest[5]}};
  if (!plan.volume_and_line)
    return eval_block<kApart>(plan, filled, 0, left, stride, scratch, out.from(0, whole));
  float values[kTogether * kLanes];
  eval_volumes<false>(plan, filled, kLanes, scratch.volumes, {values, kLanes, 1});
  for (std::size_t c = 0; c < kTogether; ++c)
    for (std::size_t i = 0; i < left; ++i) *out.at(c, whole + i) = values[c * kLanes + i];
}

void eval_directions(const FactoredPlan& plan, const DirectionPointers& in, std::size_t count,
                     const ValuePointers& out) {
  eval_all<false>(plan, in, count, out);
}

void eval_lobes_apart(const FactoredPlan& plan, const DirectionPointers& in, std::size_t count,
                      const ValuePointers& out) {
  eval_all<true>(plan, in, count, out);
}

// Kept out of line: inlined, its memory would be set up for volumes too.
HWY_NOINLINE void eval_any_one(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, float* f) {
#if HWY_TARGET != HWY_SCALAR
  if (plan.steps.size() <= FactoredPlan::kMaxSteps) return eval_one_pair(plan, wi, wo, f);
#endif
  const float w[] = {static_cast<float>(wi.x), static_cast<float>(wi.y), static_cast<float>(wi.z),
                     static_cast<float>(wo.x), static_cast<float>(wo.y), static_cast<float>(wo.z)};
  eval_directions(plan, {{w, w + 1, w + 2, w + 3, w + 4, w + 5}}, 1, {f, 1, plan.channels});
}

void eval_one_in_floats(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, float* f) {
#if HWY_TARGET != HWY_SCALAR
  if (plan.volume_and_line) return eval_one_of_volume(plan, wi, wo, f);
#endif
  eval_any_one(plan, wi, wo, f);
}

HWY_NOINLINE void eval_any_one(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, double* f) {
  std::array<float, SymmetrizedBrdf::kMaxChannels> values;  // only the first `channels` are touched
  eval_any_one(plan, wi, wo, values.data());
  std::copy_n(values.begin(), plan.channels, f);
}

void eval_one_in_doubles(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, double* f) {
#if HWY_TARGET != HWY_SCALAR
  if (plan.volume_and_line) return eval_one_of_volume(plan, wi, wo, f);
#endif
  eval_any_one(plan, wi, wo, f);
}

// Evaluates the sum of lobes times weights for a model of one or three channels.
void eval_one_weighted(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, const float* weights,
                       float* f) {
#if HWY_TARGET != HWY_SCALAR
  if (plan.steps.size() <= FactoredPlan::kMaxSteps) return eval_one_pair<true>(plan, wi, wo, f, weights);
#endif
  const float w[] = {static_cast<float>(wi.x), static_cast<float>(wi.y), static_cast<float>(wi.z),
                     static_cast<float>(wo.x), static_cast<float>(wo.y), static_cast<float>(wo.z)};
  std::array<float, kTogether * LobeEvaluator::kMaxLobes> apart;
  eval_lobes_apart(plan, {{w, w + 1, w + 2, w + 3, w + 4, w + 5}}, 1, {apart.data(), 1, plan.channels});
  std::fill_n(f, plan.channels, 0.0f);
  for (std::size_t j = 0; j < plan.products.size(); ++j)
    for (std::size_t c = 0; c < plan.channels; ++c)
      f[c] += weights[FactoredPlan::kRowStride * j + c] * apart[j * plan.channels + c];
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

HWY_EXPORT(eval_lobes_apart);
HWY_EXPORT(eval_one_weighted);
HWY_EXPORT(eval_directions);
HWY_EXPORT(eval_one_in_floats);
HWY_EXPORT(eval_one_in_doubles);

namespace {

/// Chooses the instruction set once. A kernel whose address is taken before would look for it at every call.
void choose_instructions() {
  if (!hwy::GetChosenTarget().IsInitialized()) hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

FactoredEvaluator::FactoredEvaluator(const FactoredBrdf& brdf) {
  const auto plan = std::make_shared<FactoredPlan>(brdf);
  choose_instructions();
  plan->one_in_floats = &HWY_DYNAMIC_DISPATCH(eval_one_in_floats);
  plan->one_in_doubles = &HWY_DYNAMIC_DISPATCH(eval_one_in_doubles);
  plan_ = plan;
}

std::size_t FactoredEvaluator::channels() const noexcept {
  return plan_->channels;
}

bool FactoredEvaluator::isotropic() const noexcept {
  return plan_->isotropic;
}

double FactoredEvaluator::rounding_bound() const noexcept {
  return plan_->rounding_bound;
}

void FactoredEvaluator::eval(const DirectionSpans& d, std::span<float> f) const noexcept {
  eval(d, f, d.size());
}

void FactoredEvaluator::eval(const DirectionSpans& d, std::span<float> f, std::size_t plane) const noexcept {
  const std::size_t count = d.size();
  assert(d.wi_y.size() == count && d.wi_z.size() == count && d.wo_x.size() == count &&
         d.wo_y.size() == count && d.wo_z.size() == count && plane >= count &&
         f.size() == (plan_->channels - 1) * plane + count);
  HWY_DYNAMIC_DISPATCH(eval_directions)
  (*plan_, {{d.wi_x.data(), d.wi_y.data(), d.wi_z.data(), d.wo_x.data(), d.wo_y.data(), d.wo_z.data()}},
   count, {f.data(), plane, 1});
}

void FactoredEvaluator::eval(const DirectionRows& d, std::span<float> f) const noexcept {
  const std::size_t count = d.size();
  assert(d.wi.size() == 3 * count && d.wo.size() == 3 * count && f.size() == plan_->channels * count);
  const float *const wi = d.wi.data(), *const wo = d.wo.data();
  HWY_DYNAMIC_DISPATCH(eval_directions)
  (*plan_, {{wi, wi + 1, wi + 2, wo, wo + 1, wo + 2}, 3}, count, {f.data(), 1, plan_->channels});
}

void FactoredEvaluator::eval(Vec3 wi, Vec3 wo, std::span<float> f) const noexcept {
  assert(f.size() == plan_->channels);
  plan_->one_in_floats(*plan_, wi, wo, f.data());
}

bool FactoredEvaluator::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  assert(f.size() == plan_->channels);
  plan_->one_in_doubles(*plan_, wi, wo, f.data());
  return true;
}

LobeEvaluator::LobeEvaluator(const FactoredBrdf& brdf) {
  if ((brdf.channels() != 1 && brdf.channels() != 3) || brdf.lobes().size() > kMaxLobes)
    throw Error(fmt::format("lobes apart: expected 1 or 3 channels and at most {} lobes, found {} and {}",
                            kMaxLobes, brdf.channels(), brdf.lobes().size()));
  const auto plan = std::make_shared<FactoredPlan>(brdf);
  choose_instructions();
  plan->one_weighted = &HWY_DYNAMIC_DISPATCH(eval_one_weighted);
  plan_ = plan;
}

std::size_t LobeEvaluator::channels() const noexcept {
  return plan_->channels;
}

std::size_t LobeEvaluator::lobes() const noexcept {
  return plan_->products.size();
}

double LobeEvaluator::rounding_bound() const noexcept {
  return plan_->rounding_bound;
}

void LobeEvaluator::eval(const DirectionSpans& d, std::span<float> f) const noexcept {
  const std::size_t count = d.size();
  assert(f.size() == plan_->products.size() * plan_->channels * count);
  HWY_DYNAMIC_DISPATCH(eval_lobes_apart)
  (*plan_, {{d.wi_x.data(), d.wi_y.data(), d.wi_z.data(), d.wo_x.data(), d.wo_y.data(), d.wo_z.data()}},
   count, {f.data(), count, 1});
}

void LobeEvaluator::eval(Vec3 wi, Vec3 wo, std::span<const float> weights,
                         std::span<float> f) const noexcept {
  assert(f.size() == plan_->channels && weights.size() == kWeightStride * plan_->products.size());
  plan_->one_weighted(*plan_, wi, wo, weights.data(), f.data());
}

}  // namespace burnish
#endif
