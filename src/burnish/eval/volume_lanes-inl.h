// SPDX-License-Identifier: Apache-2.0
// Per-target include: one lobe of a volume over theta_h, theta_d and phi_d times a line over theta_h, the form of
// fits with two fetches, in one pass. One pair uses lanes across angles; many pairs use a lane a pair. Both use the
// same formulas in the same order, so the bits are the same.
#if defined(BURNISH_EVAL_VOLUME_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_VOLUME_LANES_INL_H_
#undef BURNISH_EVAL_VOLUME_LANES_INL_H_
#else
#define BURNISH_EVAL_VOLUME_LANES_INL_H_
#endif

#include <algorithm>
#include <limits>

#include <hwy/cache_control.h>

#include <burnish/eval/factored_plan.h>
#include <burnish/eval/lookup_lanes-inl.h>
#include <burnish/eval/projection_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

// The formulas are those of projection-inl.h, with s = wi + wo and d = wi - wo, whose sign does not matter. Their
// order differs: lanes across angles, or roots before quotients. factored_eval_test.cpp compares them with the
// definition:
//   theta_h   r = |s_xy|                den = |s| + s_z
//   theta_d   r = |d|                   den = |s| + 2
//   phi_d     r = |s_y d_x - s_x d_y|   den = |(d_z |s|, r)| + |d_z| |s|
// All four lengths are roots of sums of squares, and none waits for another's. Vectors that are no unit vectors and
// squares that vanish can give r > den, which ends at the last node as r = den does.

/// Returns the places where lookups begin, in floats from the tables' start.
template <class Tag>
HWY_INLINE hn::Vec<hn::RebindToSigned<Tag>> first_floats(const LaneCellOf<Tag>& cell,
                                                         hn::Vec<hn::RebindToSigned<Tag>> floats,
                                                         hn::Vec<hn::RebindToSigned<Tag>> start) {
  return hn::Add(hn::Mul(hn::BitCast(hn::RebindToSigned<Tag>(), cell.shifted.raw), floats), start);
}

/// The place of the rows, and floats to the next row and layer of the volume.
struct VolumeRows {
  const float* values;
  std::size_t above, layer;

  HWY_INLINE explicit VolumeRows(const FactoredPlan& plan)
      : values(plan.values.data()), above(plan.volume_and_line->above), layer(plan.volume_and_line->layer) {}

  HWY_INLINE const float* at(std::int32_t floats) const {
    return values + static_cast<std::uint32_t>(floats);
  }
  /// Returns the volume's value times the line's, at these floats and fractions of their cells.
  HWY_INLINE Quad product(std::int32_t volume, std::int32_t line, float x, float y, float z,
                          float along) const {
    const float* const node = at(volume);
    return interpolate(at(line), along) * interpolate(node, node + above, layer, x, y, z);
  }
};

#if HWY_TARGET != HWY_SCALAR

HWY_INLINE void store_three(hn::Vec<D4> value, float* f) {
  const hn::Half<D4> d2;
  hn::StoreU(hn::LowerHalf(d2, value), d2, f);
  f[2] = hn::GetLane(hn::UpperHalf(d2, value));
}
HWY_INLINE void store_three(hn::Vec<D4> value, double* f) {
  const hn::Half<D4> d2;
  const hn::Rebind<double, hn::Half<D4>> two;
  hn::StoreU(hn::PromoteTo(two, hn::LowerHalf(d2, value)), two, f);
  f[2] = hn::GetLane(hn::PromoteTo(two, hn::UpperHalf(d2, value)));
}

/// Evaluates one pair; f has three values.
template <class Real>
HWY_INLINE void eval_one_of_volume(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, Real* f) {
  const FactoredPlan::VolumeAndLine& v = *plan.volume_and_line;
  const D4 d4;
  const D2 d2;
  const hn::RebindToSigned<D4> di4;
  const hn::RebindToSigned<D2> di2;
  const auto swapped = [](Four a) HWY_ATTR { return Four(hn::Shuffle2301(a.raw)); };
  const auto odd_even = [](Four odd, Four even) HWY_ATTR { return Four(hn::OddEven(odd.raw, even.raw)); };

  // The lanes are x, x, y, y and z, z of wi and wo. Doubles are loaded one by one, as they were often just stored
  // like that.
  const auto both = [](const double& i, const double& o) HWY_ATTR {
    const hn::CappedTag<double, 2> two;
    return hn::DemoteTo(D2(), hn::InterleaveLower(two, hn::Set(two, i), hn::Set(two, o)));
  };
  const auto z = both(wi.z, wo.z);
  const Four xy(hn::Combine(d4, both(wi.y, wo.y), both(wi.x, wo.x))), zz(hn::Combine(d4, z, z));
  const Four y(hn::ConcatUpperUpper(d4, xy.raw, xy.raw));
  const auto excess = hn::LowerHalf(di2, excess_of(xy, y, zz));
  const auto no_directions = hn::Gt(excess, hn::BitCast(di2, hn::Set(d2, kMaxExcess)));
  const auto below = hn::Le(z, hn::Zero(d2));
  if (!hn::AllFalse(d2, hn::Or(hn::RebindMask(d2, no_directions), below))) {
    const auto none = hn::AllFalse(di2, no_directions) ? Real(0) : std::numeric_limits<Real>::quiet_NaN();
    f[0] = f[1] = f[2] = none;
    return;
  }

  // The lanes of d and s have the same order.
  alignas(16) static constexpr float kSigns[] = {-1, 1, -1, 1};
  const Four signs(hn::Load(d4, kSigns));
  const Four ds = mul_add(swapped(xy), signs, xy), ds_z = mul_add(swapped(zz), signs, zz),
             sd_z = swapped(ds_z);

  // One root gives all four lengths: |d|, |s|, |s_xy| and that of phi_d.
  const Four ds_y(hn::ConcatUpperUpper(d4, ds.raw, ds.raw));
  const Four across = mul_add(ds, ds, ds_y * ds_y), square = mul_add(ds_z, ds_z, across);
  const Four products = ds * Four(hn::Shuffle0123(ds.raw)), sine = abs(products - swapped(products));
  const Four azimuth = mul_add(sd_z * sd_z, square, sine * sine);
  const Four lengths =
      sqrt(Four(hn::ConcatUpperLower(d4, hn::InterleaveLower(d4, across.raw, azimuth.raw), square.raw)));

  // tan(theta / 2) = r / den of the angles theta_d, theta_h twice, and phi_d.
  const Four ones(1.0), s(hn::Broadcast<1>(lengths.raw));
  const Four r = odd_even(Four(hn::ConcatLowerLower(d4, sine.raw, sine.raw)), lengths);
  const Four rest = odd_even(lengths, Four(hn::ConcatUpperLower(d4, sd_z.raw, Four(2.0).raw)));
  const Four den = max(mul_add(odd_even(abs(sd_z), ones), s, rest), least_positive(Four()));
  alignas(16) static constexpr std::int32_t kAngles[] = {0, 2, 2, 3};
  const Four t(hn::TableLookupLanes((r / den).raw, hn::SetTableIndices(d4, kAngles)));

  // The position in cells is warped where the lane's spacing is a root, then split into a node and a fraction.
  const Four u(hn::IfVecThenElse(hn::BitCast(d4, hn::Load(di4, v.root.data())), sqrt(t).raw, t.raw));
  const Four cells(hn::Load(d4, v.cells.data()));
  const auto cell = cell_of(min(cells * u, cells));
  const auto first = first_floats(cell, hn::Load(di4, v.floats.data()), hn::Load(di4, v.start.data()));
  const auto volume = hn::Add(hn::Add(first, hn::Shuffle1032(first)), hn::Broadcast<3>(first));
  alignas(16) float fraction[4];
  hn::Store(cell.fraction.raw, d4, fraction);
  const Quad value = VolumeRows(plan).product(hn::GetLane(volume), hn::ExtractLane(first, 1), fraction[2],
                                              fraction[0], fraction[3], fraction[1]);
  store_three(value.raw, f);
}

#endif  // HWY_TARGET != HWY_SCALAR

/// Evaluates many pairs, a vector of them in every turn. Each turn looks up the pairs whose places were found two
/// turns before, and finds places, tangents and lengths of later pairs. Steps that need roots or divisions run one
/// turn after these began, so that waiting instructions do not fill the processor's queues. Places have two turns,
/// because single numbers are loaded from vectors that were stored. No function is called in the loop: otherwise all
/// registers would go to memory.
struct VolumePipeline {
  static constexpr std::size_t kAhead = 2 * kLanes, kRing = 4 * kLanes;  // pairs
  static constexpr std::size_t kFetched = FactoredPlan::kMaxBlock;       // memory is prefetched so far ahead
  /// Places of the lookups, in a ring of some vectors.
  alignas(64) std::int32_t volume[kRing], line[kRing];  // first floats
  alignas(64) float x[kRing], y[kRing], z[kRing], along[kRing];
  alignas(64) float above[kRing];  // > 0: both above the horizon; not-a-number: no directions

  /// Lengths, and the other values that polar angles need.
  struct Lengths {
    Lane sum, half, difference, azimuth, sum_z, sine, d_z, above;
  };
  /// tan(theta / 2) of the angles.
  struct Tangents {
    Lane half, difference, azimuth, above;
  };

  /// wi_x, wi_y, wi_z, wo_x, wo_y, wo_z in planes, or wi from w[0] and wo from w[3] on in rows.
  template <bool kRows>
  static HWY_INLINE Lengths lengths(const float* const (&w)[6], std::size_t i) {
    Lanes wi, wo;
    if constexpr (kRows) {
      hn::LoadInterleaved3(D(), w[0] + 3 * i, wi.x.raw, wi.y.raw, wi.z.raw);
      hn::LoadInterleaved3(D(), w[3] + 3 * i, wo.x.raw, wo.y.raw, wo.z.raw);
    } else {
      wi = {load(w[0] + i), load(w[1] + i), load(w[2] + i)};
      wo = {load(w[3] + i), load(w[4] + i), load(w[5] + i)};
      for (const float* plane : w) hwy::Prefetch(plane + i + kFetched);
    }
    // `above` is positive where both directions are above the horizon, and not-a-number where one is no unit vector.
    const auto excess = hn::Max(excess_of(wi.x, wi.y, wi.z), excess_of(wo.x, wo.y, wo.z));
    const Lane lit = if_positive(wi.z, wo.z), none(std::numeric_limits<double>::quiet_NaN());
    // The lengths are those of the list above: |s|, |s_xy|, |d| and the one that phi_d's den takes.
    const Lanes sum = wi + wo, apart = wi - wo;
    const Lane across = mul_add(sum.x, sum.x, sum.y * sum.y), square = mul_add(sum.z, sum.z, across);
    const Lane sine = abs(sum.y * apart.x - sum.x * apart.y), d_z = abs(apart.z);
    return {.sum = sqrt(square),
            .half = sqrt(across),
            .difference = length(apart.x, apart.y, apart.z),
            .azimuth = sqrt(mul_add(d_z * d_z, square, sine * sine)),
            .sum_z = sum.z,
            .sine = sine,
            .d_z = d_z,
            .above = Lane(hn::IfThenElse(hn::RebindMask(D(), no_directions(excess)), none.raw, lit.raw))};
  }

  static HWY_INLINE Tangents tangents(const Lengths& l) {
    return {.half = l.half / (l.sum + l.sum_z),
            .difference = l.difference / (Lane(2.0) + l.sum),
            .azimuth = l.sine / max(mul_add(l.d_z, l.sum, l.azimuth), least_positive(Lane())),
            .above = l.above};
  }

  /// Returns how far in its cell along axis k a position is, and sets where that cell begins.
  static HWY_INLINE Lane fraction(const FactoredPlan::VolumeAndLine& v, std::size_t k, Lane position,
                                  hn::Vec<DI>& first) {
    const Lane cells(v.cells[k]);
    const LaneCell cell = cell_of(within(cells * position, cells));
    first = first_floats(cell, hn::Set(DI(), v.floats[k]), hn::Set(DI(), v.start[k]));
    return cell.fraction;
  }
  /// Finds the places of the pairs at `to` of the ring; `root` is the root of theta_h's tangent.
  template <bool kRoots>
  HWY_INLINE void place(const FactoredPlan::VolumeAndLine& v, const Tangents& t, Lane root, std::size_t to) {
    const Lane d = kRoots && v.root[0] ? sqrt(t.difference) : t.difference;
    const Lane phi = kRoots && v.root[3] ? sqrt(t.azimuth) : t.azimuth;
    hn::Vec<DI> along_x, along_y, along_z, along_line;
    store(fraction(v, 2, v.root[2] ? root : t.half, along_x), x + to);
    store(fraction(v, 0, d, along_y), y + to);
    store(fraction(v, 3, phi, along_z), z + to);
    store(fraction(v, 1, v.root[1] ? root : t.half, along_line), along + to);
    hn::StoreU(hn::Add(along_x, hn::Add(along_y, along_z)), DI(), volume + to);
    hn::StoreU(along_line, DI(), line + to);
    store(t.above, above + to);
  }

#if BURNISH_TARGET_IS_AVX3
  /// Returns the numbers of pairs k and k + 4, eight times each.
  template <std::int32_t k>
  static HWY_INLINE Lane of_two(const float* from) {
    alignas(64) static constexpr std::int32_t kWhich[] = {
        k, k, k, k, k, k, k, k, k + 4, k + 4, k + 4, k + 4, k + 4, k + 4, k + 4, k + 4};
    return Lane(hn::TableLookupLanes(load(from).raw, hn::SetTableIndices(D(), kWhich)));
  }
  /// Interpolates between the volume's rows and layers: the two nodes of pairs i + k and i + k + 4.
  template <std::int32_t k>
  HWY_INLINE Lane between_rows(const VolumeRows& rows, std::size_t i) const {
    const float *const node = rows.at(volume[i + k]), *const other = rows.at(volume[i + k + 4]);
    const std::size_t above_it = rows.above + rows.layer;
    const Lane across = of_two<k>(z + i);
    const Lane low = mix(load_nodes(node, other), load_nodes(node + rows.layer, other + rows.layer), across),
               high = mix(load_nodes(node + rows.above, other + rows.above),
                          load_nodes(node + above_it, other + above_it), across);
    return mix(low, high, of_two<k>(y + i));
  }
  /// Returns the two nodes of the line.
  HWY_INLINE Lane along_line(const VolumeRows& rows, std::size_t i) const {
    return load_nodes(rows.at(line[i]), rows.at(line[i + 4]));
  }
  /// Returns the quads of pairs i + k, + 4, + 8 and + 12: VolumeRows::product() with two pairs a vector, then four.
  template <std::int32_t k>
  HWY_INLINE Lane quads(const VolumeRows& rows, std::size_t i) const {
    const Lane low = between_rows<k>(rows, i), high = between_rows<k + 8>(rows, i);
    const Lane line_low = along_line(rows, i + k), line_high = along_line(rows, i + k + 8);
    const Lane x_of(hn::Broadcast<k>(load(x + i).raw)), along_of(hn::Broadcast<k>(load(along + i).raw));
    return mix(first_nodes(line_low, line_high), second_nodes(line_low, line_high), along_of) *
           mix(first_nodes(low, high), second_nodes(low, high), x_of);
  }
#else
  HWY_INLINE Quad quad(const VolumeRows& rows, std::size_t i) const {
    return rows.product(volume[i], line[i], x[i], y[i], z[i], along[i]);
  }
#if HWY_MAX_BYTES >= 32
  /// Returns the quads of pairs i + k and i + k + 4.
  template <std::size_t k>
  HWY_INLINE Lane quads(const VolumeRows& rows, std::size_t i) const {
    return Lane(hn::Combine(D(), quad(rows, i + k + 4).raw, quad(rows, i + k).raw));
  }
#elif HWY_TARGET != HWY_SCALAR
  template <std::size_t k>
  HWY_INLINE Lane quads(const VolumeRows& rows, std::size_t i) const {
    return Lane(quad(rows, i + k).raw);
  }
#endif
#endif

  /// Calls put(i, values) for the vectors of `count` pairs, which are read in whole vectors.
  template <bool kRows, bool kRoots, class Put>
  HWY_INLINE void run(const FactoredPlan& plan, const float* const (&w)[6], std::size_t count,
                      const Put& put) {
    const FactoredPlan::VolumeAndLine& v = *plan.volume_and_line;
    const VolumeRows rows(plan);
    const std::size_t last = (count - 1) / kLanes * kLanes;
    Tangents t = tangents(lengths<kRows>(w, 0));
    Lengths l = lengths<kRows>(w, std::min(kLanes, last));
    for (std::size_t i = 0; i < std::min(kAhead, count); i += kLanes) {
      place<kRoots>(v, t, sqrt(t.half), i);
      t = tangents(l);
      l = lengths<kRows>(w, std::min(i + 2 * kLanes, last));
    }
    for (std::size_t i = 0; i < count; i += kLanes) {
      const std::size_t at = i % kRing;
      const Lane root = sqrt(t.half);
      const Tangents next = tangents(l);
      Lane value[3];
#if HWY_TARGET == HWY_SCALAR
      place<kRoots>(v, t, root, (i + kAhead) % kRing);
      l = lengths<kRows>(w, std::min(i + kAhead + 2 * kLanes, last));
      const Quad q = quad(rows, at);
      for (int c = 0; c < 3; ++c) value[c] = load(q.c + c);
#else
      Lane part[4];
      part[0] = quads<0>(rows, at);
      place<kRoots>(v, t, root, (i + kAhead) % kRing);
      part[1] = quads<1>(rows, at);
      l = lengths<kRows>(w, std::min(i + kAhead + 2 * kLanes, last));
      part[2] = quads<2>(rows, at);
      part[3] = quads<3>(rows, at);
      transpose(part, value);
#endif
      t = next;
      // The value is 0 below the horizon, and not-a-number where a vector is no direction.
      const Lane lit = load(above + at);
      const auto is_above = hn::Gt(lit.raw, hn::Zero(D()));
      for (Lane& channel : value) channel = Lane(hn::IfThenElse(is_above, channel.raw, (lit - lit).raw));
      put(i, value);
    }
  }
};

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
