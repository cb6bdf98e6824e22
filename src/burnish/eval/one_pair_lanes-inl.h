// Per-target include: one pair of directions at a time. What a batch does with a direction a lane is done here
// with lanes across projections, positions and channels, by the same formulas in the same order: the bits are
// the same.
#if defined(BURNISH_EVAL_ONE_PAIR_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_ONE_PAIR_LANES_INL_H_
#undef BURNISH_EVAL_ONE_PAIR_LANES_INL_H_
#else
#define BURNISH_EVAL_ONE_PAIR_LANES_INL_H_
#endif

#include <algorithm>
#include <limits>

#include <burnish/eval/factored_plan.h>
#include <burnish/eval/lookup_lanes-inl.h>
#include <burnish/eval/projection_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace burnish {
namespace HWY_NAMESPACE {
namespace {

constexpr std::size_t kTogether = FactoredPlan::kTogether;

#if HWY_TARGET != HWY_SCALAR

using Four = LaneOf<D4>;
using D8 = hn::CappedTag<float, FactoredPlan::Steps::kLanes>;
using Eight = LaneOf<D8>;
using DI8 = hn::RebindToSigned<D8>;

/// Lanes 0, 1, 2, 3 of four.
HWY_INLINE Four lanes_of(Four a, Four b, Four c, Four d) {
  const D4 d4;
  return Four(hn::ConcatUpperLower(d4, hn::OddEven(d.raw, c.raw), hn::OddEven(b.raw, a.raw)));
}
HWY_INLINE LanesOf<D4> lanes_of(const LanesOf<D4>& a, const LanesOf<D4>& b, const LanesOf<D4>& c,
                                const LanesOf<D4>& d) {
  return {lanes_of(a.x, b.x, c.x, d.x), lanes_of(a.y, b.y, c.y, d.y), lanes_of(a.z, b.z, c.z, d.z)};
}

/// A position of a polar angle, of a warp that is the same in all lanes.
template <class T>
HWY_INLINE T warped(WarpKind warp, bool root, T size, T parameter, const Polar<T>& polar) {
  switch (warp) {
    case WarpKind::rational:
      return rational_warp(size, parameter, polar);
    case WarpKind::power:
      return root ? power_warp(size, Half(), polar) : power_warp(size, parameter, polar);
    case WarpKind::identity:
      break;
  }
  return identity_warp(size, polar);
}
/// What a disk's x and y are multiplied by.
template <class T>
HWY_INLINE T stretched(WarpKind warp, bool root, T size, T parameter, const Polar<T>& polar) {
  switch (warp) {
    case WarpKind::rational:
      return rational_stretch(size, parameter, polar);
    case WarpKind::power:
      return root ? power_stretch(size, Half(), polar) : power_stretch(size, parameter, polar);
    case WarpKind::identity:
      break;
  }
  return identity_stretch(size, polar);
}

/// One pair, each value in every lane, and what projections share.
struct OnePair {
  LanesOf<D4> wi, wo;
  LanePairOf<D4> pair;

  HWY_INLINE OnePair(Vec3 to_light, Vec3 to_viewer) : wi(in_floats(to_light)), wo(in_floats(to_viewer)) {
    pair.sum = wi + wo;
    pair.apart = wi - wo;
    pair.length_of_sum = length(pair.sum.x, pair.sum.y, pair.sum.z);
  }
  static HWY_INLINE LanesOf<D4> in_floats(Vec3 w) { return {Four(w.x), Four(w.y), Four(w.z)}; }
  /// wi, wo and their sum, a lane each.
  HWY_INLINE LanesOf<D4> upwards() const { return lanes_of(wi, wo, pair.sum, pair.sum); }
};

/// The polar angles, in the order of FactoredPlan::Angle.
struct PolarAngles {
  Polar<Four> low, high;

  HWY_INLINE PolarAngles(const FactoredPlan& plan, const OnePair& one, const LanesOf<D4>& upwards) {
    low = polar_of(upwards, Four(hn::ConcatUpperLower(D4(), one.pair.length_of_sum.raw, Four(1.0).raw)));
    Polar<Four> angle[4];
    for (std::size_t k = 0; k < 4; ++k) angle[k] = {Four(0.0), Four(1.0)};
    using Angle = FactoredPlan::Angle;
    const auto asked = [&](Angle a) HWY_ATTR { return plan.has_angle[static_cast<std::size_t>(a)]; };
    if (asked(Angle::difference)) angle[0] = difference_angle(one.pair);
    if (asked(Angle::deviation)) angle[1] = deviation_angle(one.pair);
    if (asked(Angle::twist)) angle[2] = twist_angle(one.pair);
    if (asked(Angle::azimuth)) angle[3] = folded_azimuth(one.pair);
    high = {lanes_of(angle[0].r, angle[1].r, angle[2].r, angle[3].r),
            lanes_of(angle[0].den, angle[1].den, angle[2].den, angle[3].den)};
  }
};

/// Where lookups read: floats of the rows to step over and fractions, a lane of `steps` each.
struct OneCells {
  static constexpr std::size_t kMost = FactoredPlan::kMaxSteps * FactoredPlan::Steps::kLanes;
  alignas(64) std::int32_t floats[kMost];
  alignas(64) float fraction[kMost];

  HWY_INLINE void put(Eight position, const FactoredPlan::Steps& s, std::size_t lane, std::size_t to) {
    const auto cell = cell_of(within(position, Eight(hn::Load(D8(), s.cells.data() + lane))));
    const auto step = hn::Load(DI8(), s.floats.data() + lane);
    hn::Store(hn::Mul(node_of(cell), step), DI8(), floats + to);
    hn::Store(cell.fraction.raw, D8(), fraction + to);
  }
};

/// Disks and affine combinations: their positions, to lanes of `given`.
HWY_INLINE void find_given(const FactoredPlan::GivenSteps& steps, const OnePair& one, float* given) {
  using Kind = FactoredPlan::Source::Kind;
  Affine<LanesOf<D4>, Four> at;
  switch (steps.kind) {
    case Kind::wi:
      at = {one.wi, polar_of(one.wi, Four(1.0))};
      break;
    case Kind::wo:
      at = {one.wo, polar_of(one.wo, Four(1.0))};
      break;
    case Kind::half:
      at = {one.pair.sum, polar_of(one.pair.sum, one.pair.length_of_sum)};
      break;
    case Kind::affine:
      at = affine(steps.projection, one.wi, one.wo);
      break;
    case Kind::difference:
    case Kind::angle:
      at = doubled_difference(one.pair);
  }
  const FactoredPlan::Position& p = steps.position;
  const bool root = p.parameter == 0.5f;
  const Four size(p.size), parameter(p.parameter);
  if (!p.disk) {
    given[steps.x] = hn::GetLane(warped(p.warp, root, size, parameter, at.polar).raw);
    return;
  }
  const Four scale = stretched(p.warp, root, size, parameter, at.polar), centre(0.5 * p.cells);
  given[steps.x] = hn::GetLane(mul_add(at.vector.x, scale, centre).raw);
  given[steps.y] = hn::GetLane(mul_add(at.vector.y, scale, centre).raw);
}

HWY_INLINE void find_cells(const FactoredPlan& plan, const OnePair& one, const PolarAngles& angles,
                           OneCells& cells) {
  alignas(64) float given[OneCells::kMost];
  for (const FactoredPlan::GivenSteps& steps : plan.given) find_given(steps, one, given);
  constexpr std::size_t kLanesOfEight = hn::MaxLanes(D8()), kAll = FactoredPlan::Steps::kLanes;
#if HWY_MAX_BYTES >= 32
  const D8 d8;
  const auto r = hn::Combine(d8, angles.high.r.raw, angles.low.r.raw);
  const auto den = hn::Combine(d8, angles.high.den.raw, angles.low.den.raw);
#else
  float r[kAll], den[kAll];
  hn::StoreU(angles.low.r.raw, D4(), r);
  hn::StoreU(angles.high.r.raw, D4(), r + 4);
  hn::StoreU(angles.low.den.raw, D4(), den);
  hn::StoreU(angles.high.den.raw, D4(), den + 4);
#endif
  for (std::size_t k = 0; k < plan.steps.size(); ++k) {
    const FactoredPlan::Steps& s = plan.steps[k];
    for (std::size_t lane = 0; lane < kAll; lane += kLanesOfEight) {
      const std::size_t to = kAll * k + lane;
      if (s.given) {
        cells.put(Eight(hn::Load(D8(), given + to)), s, lane, to);
        continue;
      }
      Polar<Eight> polar;
#if HWY_MAX_BYTES >= 32
      const auto index = hn::SetTableIndices(d8, s.angle.data());
      polar = {Eight(hn::TableLookupLanes(r, index)), Eight(hn::TableLookupLanes(den, index))};
#else
      alignas(16) float own_r[kAll], own_den[kAll];
      for (std::size_t i = 0; i < kLanesOfEight; ++i) {
        own_r[i] = r[s.angle[lane + i]];
        own_den[i] = den[s.angle[lane + i]];
      }
      polar = {Eight(hn::Load(D8(), own_r)), Eight(hn::Load(D8(), own_den))};
#endif
      const Eight size(hn::Load(D8(), s.size.data() + lane)),
          parameter(hn::Load(D8(), s.parameter.data() + lane));
      cells.put(warped(s.warp, s.root, size, parameter, polar), s, lane, to);
    }
  }
}

/// A table's value for one pair. `at`: the axes' lanes.
template <int kAxes>
HWY_INLINE Quad looked_up(const FactoredPlan::Lookup& lookup, const float* rows, const OneCells& cells,
                          const std::array<std::uint32_t, 3>& at) {
  const float* node = rows + cells.floats[at[0]];
  const float x = cells.fraction[at[0]];
  if constexpr (kAxes == 1) {
    return interpolate(node, x);
  } else {
    const std::size_t above = lookup.width * FactoredPlan::kRowStride;
    node += cells.floats[at[1]];
    const float y = cells.fraction[at[1]];
    if constexpr (kAxes == 2) {
      return interpolate(node, node + above, x, y);
    } else {
      node += cells.floats[at[2]];
      return interpolate(node, node + above, lookup.layer * FactoredPlan::kRowStride, x, y,
                         cells.fraction[at[2]]);
    }
  }
}
template <int kAxes>
HWY_INLINE Quad looked_up(const FactoredPlan::Lookup& lookup, const float* rows, const OneCells& cells) {
  const Quad value = looked_up<kAxes>(lookup, rows, cells, lookup.steps_at);
  return lookup.pair ? value * looked_up<kAxes>(lookup, rows, cells, lookup.pair_steps_at) : value;
}

/// Three channels: sum over lobes of scale times lookups [HomomorphicBrdf, eq. 4].
HWY_INLINE Quad sum_of_products(const FactoredPlan& plan, std::size_t group, const OneCells& cells) {
  Quad sum{hn::Zero(D4())};
  for (const FactoredPlan::Product& product : plan.products) {
    Quad value = load_quad(product.scale.data() + group * kTogether);
    for (std::size_t k = product.first; k < product.last; ++k) {
      const FactoredPlan::Lookup& lookup = plan.lookups[k];
      const float* const rows =
          plan.values.data() + lookup.rows + (lookup.shared ? 0 : group * lookup.row_block);
      switch (lookup.axes) {
        case 1:
          value = value * looked_up<1>(lookup, rows, cells);
          break;
        case 2:
          value = value * looked_up<2>(lookup, rows, cells);
          break;
        default:
          value = value * looked_up<3>(lookup, rows, cells);
      }
    }
    sum = Quad{hn::Add(sum.raw, value.raw)};
  }
  return sum;
}

/// f has the plan's channels; the plan at most kMaxSteps steps.
void eval_one_pair(const FactoredPlan& plan, Vec3 wi, Vec3 wo, float* f) {
  using D2 = hn::Half<D4>;
  using DI2 = hn::RebindToSigned<D2>;
  const D2 d2;
  const DI2 di2;
  const OnePair one(wi, wo);
  const LanesOf<D4> upwards = one.upwards();
  // of wi and wo
  const auto excess = hn::LowerHalf(di2, excess_of(upwards.x, upwards.y, upwards.z));
  const bool directions = hn::AllFalse(di2, hn::Gt(excess, hn::BitCast(di2, hn::Set(d2, kMostExcess))));
  const bool lit = hn::AllTrue(d2, hn::Gt(hn::LowerHalf(d2, upwards.z.raw), hn::Zero(d2)));
  if (!directions || !lit) {
    std::fill(f, f + plan.channels, directions ? 0.0f : std::numeric_limits<float>::quiet_NaN());
    return;
  }
  OneCells cells;
  find_cells(plan, one, PolarAngles(plan, one, upwards), cells);
  for (std::size_t group = 0; group * kTogether < plan.channels; ++group, f += kTogether) {
    const auto sum = sum_of_products(plan, group, cells).raw;
    const std::size_t left = plan.channels - group * kTogether;
    if (left >= kTogether) {
      hn::StoreU(hn::LowerHalf(d2, sum), d2, f);
      f[2] = hn::GetLane(hn::UpperHalf(d2, sum));
    } else {
      float rest[4];
      hn::StoreU(sum, D4(), rest);
      std::copy(rest, rest + left, f);
    }
  }
}

#endif  // HWY_TARGET != HWY_SCALAR

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace burnish
HWY_AFTER_NAMESPACE();

#endif
