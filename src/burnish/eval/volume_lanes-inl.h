// Per-target include: one lobe of a volume over theta_h, theta_d and phi_d times a line over theta_h, the form that
// a fit of two fetches has, in one go: of one pair with lanes across angles, of many with a pair a lane. Both by the
// same formulas in the same order: the bits are the same.
#if defined(BURNISH_EVAL_VOLUME_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_VOLUME_LANES_INL_H_
#undef BURNISH_EVAL_VOLUME_LANES_INL_H_
#else
#define BURNISH_EVAL_VOLUME_LANES_INL_H_
#endif

#include <limits>

#include <hwy/cache_control.h>

#include <burnish/eval/factored_plan.h>
#include <burnish/eval/lookup_lanes-inl.h>
#include <burnish/eval/projection_lanes-inl.h>

BURNISH_BEGIN_TARGET;

// With s = wi + wo and d = wi - wo, whose sign does not matter, the formulas of projection-inl.h. Polar angles of many
// are instances of them; the rest is in an order of its own, lanes across angles, and held to the definition by
// factored_eval_test.cpp:
//   theta_h   r = |s_xy|                den = |s| + s_z
//   theta_d   r = |d|                   den = |s| + 2
//   phi_d     r = |s_y d_x - s_x d_y|   den = |(d_z |s|, r)| + |d_z| |s|
// All four lengths are roots of sums of squares, and none waits for another's. r > den, of directions that are no unit
// vectors and of squares that vanish, ends at the last node like r = den.

/// Where lookups begin, in floats from the tables' start.
template <class Tag>
HWY_INLINE hn::Vec<hn::RebindToSigned<Tag>> first_floats(const LaneCellOf<Tag>& cell,
                                                         hn::Vec<hn::RebindToSigned<Tag>> floats,
                                                         hn::Vec<hn::RebindToSigned<Tag>> start) {
  return hn::Add(hn::Mul(hn::BitCast(hn::RebindToSigned<Tag>(), cell.shifted.raw), floats), start);
}

/// Where the rows lie, and floats to the next row and layer of the volume.
struct VolumeRows {
  const float* values;
  std::size_t above, layer;

  HWY_INLINE explicit VolumeRows(const FactoredPlan& plan)
      : values(plan.values.data()), above(plan.volume_and_line->above), layer(plan.volume_and_line->layer) {}

  /// The volume's value times the line's, at these floats and fractions of their cells.
  HWY_INLINE Quad product(std::uint32_t volume, std::uint32_t line, float x, float y, float z,
                          float along) const {
    const float* const node = values + volume;
    return interpolate(values + line, along) * interpolate(node, node + above, layer, x, y, z);
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

/// f has three values.
template <class Real>
HWY_INLINE void eval_one_of_volume(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, Real* f) {
  const FactoredPlan::VolumeAndLine& v = *plan.volume_and_line;
  using Four = LaneOf<D4>;
  using D2 = hn::Half<D4>;
  const D4 d4;
  const D2 d2;
  const hn::RebindToSigned<D4> di4;
  const hn::RebindToSigned<D2> di2;
  const auto swapped = [](Four a) HWY_ATTR { return Four(hn::Shuffle2301(a.raw)); };
  const auto odd_even = [](Four odd, Four even) HWY_ATTR { return Four(hn::OddEven(odd.raw, even.raw)); };

  // wi and wo: x, x, y, y and z, z. Doubles are loaded one by one: they were often just stored like that.
  const auto both = [](const double& i, const double& o) HWY_ATTR {
    const hn::CappedTag<double, 2> two;
    return hn::DemoteTo(D2(), hn::InterleaveLower(two, hn::Set(two, i), hn::Set(two, o)));
  };
  const auto z = both(wi.z, wo.z);
  const Four xy(hn::Combine(d4, both(wi.y, wo.y), both(wi.x, wo.x))), zz(hn::Combine(d4, z, z));
  const Four y(hn::ConcatUpperUpper(d4, xy.raw, xy.raw));
  const auto excess = hn::LowerHalf(di2, excess_of(xy, y, zz));
  const auto no_directions = hn::Gt(excess, hn::BitCast(di2, hn::Set(d2, kMostExcess)));
  const auto below = hn::Le(z, hn::Zero(d2));
  if (!hn::AllFalse(d2, hn::Or(hn::RebindMask(d2, no_directions), below))) {
    const auto none = hn::AllFalse(di2, no_directions) ? Real(0) : std::numeric_limits<Real>::quiet_NaN();
    f[0] = f[1] = f[2] = none;
    return;
  }

  // d and s: x, x, y, y and z, z, once more
  alignas(16) static constexpr float kSigns[] = {-1, 1, -1, 1};
  const Four signs(hn::Load(d4, kSigns));
  const Four ds = mul_add(swapped(xy), signs, xy), ds_z = mul_add(swapped(zz), signs, zz),
             sd_z = swapped(ds_z);

  // lengths |d|, |s|, |s_xy| and that of phi_d
  const Four ds_y(hn::ConcatUpperUpper(d4, ds.raw, ds.raw));
  const Four across = mul_add(ds, ds, ds_y * ds_y), square = mul_add(ds_z, ds_z, across);
  const Four products = ds * Four(hn::Shuffle0123(ds.raw)), sine = abs(products - swapped(products));
  const Four azimuth = mul_add(sd_z * sd_z, square, sine * sine);
  const Four lengths =
      sqrt(Four(hn::ConcatUpperLower(d4, hn::InterleaveLower(d4, across.raw, azimuth.raw), square.raw)));

  // angles: theta_d, theta_h twice, phi_d
  const Four ones(1.0), s(hn::Broadcast<1>(lengths.raw));
  const Four r = odd_even(Four(hn::ConcatLowerLower(d4, sine.raw, sine.raw)), lengths);
  const Four rest = odd_even(lengths, Four(hn::ConcatUpperLower(d4, sd_z.raw, Four(2.0).raw)));
  const Four den = max(mul_add(odd_even(abs(sd_z), ones), s, rest), least_positive(Four()));
  alignas(16) static constexpr std::int32_t kAngles[] = {0, 2, 2, 3};
  const Four t(hn::TableLookupLanes((r / den).raw, hn::SetTableIndices(d4, kAngles)));

  // cells
  const Four u(hn::IfVecThenElse(hn::BitCast(d4, hn::Load(di4, v.root.data())), sqrt(t).raw, t.raw));
  const Four cells(hn::Load(d4, v.cells.data()));
  const auto cell = cell_of(min(cells * u, cells));
  const auto first = first_floats(cell, hn::Load(di4, v.floats.data()), hn::Load(di4, v.start.data()));
  const auto volume = hn::Add(hn::Add(first, hn::Shuffle1032(first)), hn::Broadcast<3>(first));
  alignas(16) float fraction[4];
  hn::Store(cell.fraction.raw, d4, fraction);
  const Quad value = VolumeRows(plan).product(static_cast<std::uint32_t>(hn::GetLane(volume)),
                                              static_cast<std::uint32_t>(hn::ExtractLane(first, 1)),
                                              fraction[2], fraction[0], fraction[3], fraction[1]);
  store_three(value.raw, f);
}

#endif  // HWY_TARGET != HWY_SCALAR

/// Where a block of pairs looks up.
struct VolumeCells {
  static constexpr std::size_t kMost = FactoredPlan::kMaxBlock;
  alignas(64) std::int32_t volume[kMost], line[kMost];  // first floats
  alignas(64) float x[kMost], y[kMost], z[kMost], along[kMost];
  alignas(64) float above[kMost];  // > 0: both above the horizon; not-a-number: no directions

  HWY_INLINE Quad value(const VolumeRows& rows, std::size_t i) const {
    return rows.product(static_cast<std::uint32_t>(volume[i]), static_cast<std::uint32_t>(line[i]), x[i],
                        y[i], z[i], along[i]);
  }

  /// Of `count` pairs, whole vectors: wi_x, wi_y, wi_z, wo_x, wo_y, wo_z in planes, or wi from w[0] and wo from w[3] on
  /// in rows. Whether all are directions.
  template <bool kRows>
  HWY_INLINE bool find(const FactoredPlan::VolumeAndLine& v, const float* const (&w)[6], std::size_t count) {
    const Lane cells[] = {Lane(v.cells[0]), Lane(v.cells[1]), Lane(v.cells[2]), Lane(v.cells[3])};
    const auto fraction = [&](std::size_t k, Lane t, Lane root, hn::Vec<DI>& first) HWY_ATTR {
      const LaneCell cell = cell_of(within(cells[k] * (v.root[k] ? root : t), cells[k]));
      first = first_floats(cell, hn::Set(DI(), v.floats[k]), hn::Set(DI(), v.start[k]));
      return cell.fraction;
    };
    const bool any_root = v.root[0] || v.root[3];
    auto worst = hn::Zero(DI());
    for (std::size_t i = 0; i < count; i += kLanes) {
      // directions, and which are none
      Lanes wi, wo;
      if constexpr (kRows) {
        hn::LoadInterleaved3(D(), w[0] + 3 * i, wi.x.raw, wi.y.raw, wi.z.raw);
        hn::LoadInterleaved3(D(), w[3] + 3 * i, wo.x.raw, wo.y.raw, wo.z.raw);
      } else {
        wi = {load(w[0] + i), load(w[1] + i), load(w[2] + i)};
        wo = {load(w[3] + i), load(w[4] + i), load(w[5] + i)};
        for (const float* plane : w) hwy::Prefetch(plane + i + kMost);  // for the next block
      }
      const auto excess = hn::Max(excess_of(wi.x, wi.y, wi.z), excess_of(wo.x, wo.y, wo.z));
      worst = hn::Max(worst, excess);
      const Lane lit = if_positive(wi.z, wo.z), none(std::numeric_limits<double>::quiet_NaN());
      store(Lane(hn::IfThenElse(hn::RebindMask(D(), no_directions(excess)), none.raw, lit.raw)), above + i);

      // what the lengths and the polar angles take
      const Lanes sum = wi + wo, apart = wi - wo;
      const Lane across = mul_add(sum.x, sum.x, sum.y * sum.y), square = mul_add(sum.z, sum.z, across);
      const Lane sine = abs(sum.y * apart.x - sum.x * apart.y), d_z = abs(apart.z);
      const Lane azimuth = sqrt(mul_add(d_z * d_z, square, sine * sine));

      const LanePairOf<D> pair{sum, apart, sqrt(square)};
      const Polar<Lane> h = polar_of(sum, pair.sum_length()), d = difference_angle(pair);
      const Lane t_h = h.r / h.den, t_d = d.r / d.den;
      const Lane t_phi = sine / max(mul_add(d_z, pair.sum_length(), azimuth), least_positive(Lane()));
      // cells, and where the two lookups begin
      const Lane root_h = sqrt(t_h), root_d = any_root ? sqrt(t_d) : t_d,
                 root_phi = any_root ? sqrt(t_phi) : t_phi;
      hn::Vec<DI> along_x, along_y, along_z, along_line;
      store(fraction(2, t_h, root_h, along_x), x + i);
      store(fraction(0, t_d, root_d, along_y), y + i);
      store(fraction(3, t_phi, root_phi, along_z), z + i);
      store(fraction(1, t_h, root_h, along_line), along + i);
      hn::StoreU(hn::Add(along_x, hn::Add(along_y, along_z)), DI(), volume + i);
      hn::StoreU(along_line, DI(), line + i);
    }
    return hn::AllFalse(DI(), no_directions(worst));
  }
};

BURNISH_END_TARGET;

#endif
