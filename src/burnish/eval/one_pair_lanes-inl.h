// SPDX-License-Identifier: Apache-2.0
// Per-target include: one pair of directions at a time. A batch has a direction in each lane; here the lanes are
// projections, positions and channels. The formulas and their order are the same, so the bits are too.
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
BURNISH_BEGIN_TARGET;

constexpr std::size_t kTogether = FactoredPlan::kTogether;

#if HWY_TARGET != HWY_SCALAR

using D8 = hn::CappedTag<float, FactoredPlan::Steps::kLanes>;
using Eight = LaneOf<D8>;
using DI8 = hn::RebindToSigned<D8>;
constexpr std::size_t kEight = hn::MaxLanes(D8());  // fewer where vectors are shorter

// Logarithms and exponentials are kept out of line: otherwise their constants would be loaded for all models.
template <class Tag>
HWY_NOINLINE LaneOf<Tag> power_warp_apart(LaneOf<Tag> size, LaneOf<Tag> exponent,
                                          const Polar<LaneOf<Tag>>& polar) {
  return power_warp(size, exponent, polar);
}

/// Returns the position of a polar angle.
template <class T>
HWY_INLINE T warped(FactoredPlan::Spacing spacing, T size, T parameter, const Polar<T>& polar) {
  using Spacing = FactoredPlan::Spacing;
  switch (spacing) {
    case Spacing::rational:
      return rational_warp(size, parameter, polar);
    case Spacing::root:
      return power_warp(size, Half(), polar);
    case Spacing::power:
      return power_warp(size, parameter, polar);
    case Spacing::identity:
    case Spacing::given:
      break;
  }
  return identity_warp(size, polar);
}
/// Returns the factor of a disk's x and y.
template <class T>
HWY_INLINE T stretched(FactoredPlan::Spacing spacing, T size, T parameter, const Polar<T>& polar) {
  using Spacing = FactoredPlan::Spacing;
  switch (spacing) {
    case Spacing::rational:
      return rational_stretch(size, parameter, polar);
    case Spacing::root:
      return power_stretch(size, Half(), polar);
    case Spacing::power:
      return power_stretch(size, parameter, polar);
    case Spacing::identity:
    case Spacing::given:
      break;
  }
  return identity_stretch(size, polar);
}

/// One pair: wi, wo, their sum and their difference are lanes of `all`; values that the formulas take one by one fill
/// all lanes.
struct OnePair {
  LanesOf<D4> all;
  LanePairOf<D4> pair;

  HWY_INLINE OnePair(const Vec3& to_light, const Vec3& to_viewer) {
    const D4 d4;
    const hn::Repartition<double, D4> halves;
    const auto join = [&](auto low, auto high) HWY_ATTR {
      return Four(
          hn::BitCast(d4, hn::InterleaveLower(halves, hn::BitCast(halves, low), hn::BitCast(halves, high))));
    };
    const auto join_upper = [&](auto low, auto high) HWY_ATTR {
      return Four(
          hn::BitCast(d4, hn::InterleaveUpper(halves, hn::BitCast(halves, low), hn::BitCast(halves, high))));
    };
    const auto wi = row(to_light), wo = row(to_viewer), sum = hn::Add(wi, wo), apart = hn::Sub(wi, wo);
    const auto xy = hn::InterleaveLower(d4, wi, wo), zz = hn::InterleaveUpper(d4, wi, wo);
    const auto sum_xy = hn::InterleaveLower(d4, sum, apart), sum_zz = hn::InterleaveUpper(d4, sum, apart);
    all = {join(xy, sum_xy), join_upper(xy, sum_xy), join(zz, sum_zz)};
    pair.sum = of_all<2>();
    pair.apart = of_all<3>();
    pair.length_of_sum = Four(hn::Broadcast<2>(length(all.x, all.y, all.z).raw));
  }
  /// wi, wo, their sum or their difference in every lane.
  template <int kLane>
  HWY_INLINE LanesOf<D4> of_all() const {
    return {Four(hn::Broadcast<kLane>(all.x.raw)), Four(hn::Broadcast<kLane>(all.y.raw)),
            Four(hn::Broadcast<kLane>(all.z.raw))};
  }
  static HWY_INLINE hn::Vec<D4> row(const Vec3& w) {
    const hn::CappedTag<double, 2> two;
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return hn::Combine(D4(), hn::Set(D2(), static_cast<float>(w.z)),
                       hn::DemoteTo(D2(), hn::LoadU(two, &w.x)));
  }
};

/// The polar angles, in the order of FactoredPlan::Angle.
struct PolarAngles {
  Polar<Four> low, high;

  HWY_INLINE PolarAngles(const FactoredPlan& plan, const OnePair& one) {
    using Angle = FactoredPlan::Angle;
    const D4 d4;
    const auto asked = [&](Angle a) HWY_ATTR { return plan.has_angle[static_cast<std::size_t>(a)]; };
    const auto second_of = [&](const Polar<Four>& angles, const Polar<Four>& angle) HWY_ATTR {
      return Polar<Four>{Four(hn::OddEven(angle.r.raw, angles.r.raw)),
                         Four(hn::OddEven(angle.den.raw, angles.den.raw))};
    };
    low = polar_of(one.all, Four(hn::ConcatUpperLower(d4, one.pair.length_of_sum.raw, Four(1.0).raw)));
    if (asked(Angle::azimuth)) {
      const Polar<Four> angle = folded_azimuth(one.pair), odd = second_of(low, angle);
      low = {Four(hn::ConcatUpperLower(d4, odd.r.raw, low.r.raw)),
             Four(hn::ConcatUpperLower(d4, odd.den.raw, low.den.raw))};
    }
    high = low;
    if (asked(Angle::difference)) high = difference_angle(one.pair);
    if (asked(Angle::deviation)) high = second_of(high, deviation_angle(one.pair));
  }
};

/// The places of lookups: floats to step over and fractions, one lane of `steps` each.
struct OneCells {
  static constexpr std::size_t kMax = FactoredPlan::kMaxSteps * FactoredPlan::Steps::kLanes;
  alignas(64) std::int32_t floats[kMax];
  alignas(64) float fraction[kMax];

  HWY_INLINE void put(Eight position, const FactoredPlan::Steps& s, std::size_t lane, std::size_t to) {
    const Eight cells(hn::Load(D8(), s.cells.data() + lane));
    const auto cell = cell_of(min(max(position, Eight(0.0)), cells));
    const auto step = hn::Load(DI8(), s.floats.data() + lane);
    hn::Store(hn::Mul(node_of(cell), step), DI8(), floats + to);
    hn::Store(cell.fraction.raw, D8(), fraction + to);
  }
};

/// Returns the polar angle of a projection that is not found together with others, in every lane.
HWY_INLINE Polar<Four> angle_apart(const Projection& projection, const OnePair& one) {
  if (projection.kind == Projection::Kind::affine)
    return affine(projection, one.of_all<0>(), one.of_all<1>()).polar;
  return with_angle(projection.kind,
                    [&](const auto& angle) HWY_ATTR { return Polar<Four>(angle(one.pair)); });
}

/// Finds the positions of disks, and of angles beyond the table's size, and writes them to their lanes of `given`.
HWY_NOINLINE void find_given(const FactoredPlan& plan, const OnePair& one, float* given) {
  using Kind = FactoredPlan::Source::Kind;
  const LanesOf<D4> wi = one.of_all<0>(), wo = one.of_all<1>();
  for (const FactoredPlan::GivenSteps& steps : plan.given) {
    // The projected vector and its polar angle come first.
    Affine<LanesOf<D4>, Four> at;
    switch (steps.kind) {
      case Kind::wi:
        at = {wi, polar_of(wi, Four(1.0))};
        break;
      case Kind::wo:
        at = {wo, polar_of(wo, Four(1.0))};
        break;
      case Kind::half:
        at = {one.pair.sum, polar_of(one.pair.sum, one.pair.length_of_sum)};
        break;
      case Kind::affine:
        at = affine(steps.projection, wi, wo);
        break;
      case Kind::difference:
        at = doubled_difference(one.pair);
        break;
      case Kind::angle:
        at.polar = angle_apart(steps.projection, one);
    }
    // Then the position: two numbers for a disk, one for a line.
    const FactoredPlan::Position& p = steps.position;
    const Four size(p.size), parameter(p.parameter), centre(0.5 * p.cells);
    if (p.disk) {
      const Four scale = stretched(steps.spacing, size, parameter, at.polar);
      given[steps.x] = hn::GetLane(mul_add(at.vector.x, scale, centre).raw);
      given[steps.y] = hn::GetLane(mul_add(at.vector.y, scale, centre).raw);
    } else {
      given[steps.x] = hn::GetLane(warped(steps.spacing, size, parameter, at.polar).raw);
    }
  }
}

/// Eight polar angles to choose from.
class AngleTable {
 public:
#if HWY_MAX_BYTES >= 32
  HWY_INLINE AngleTable(const float* r, const float* den)
      : r_(hn::Load(D8(), r)), den_(hn::Load(D8(), den)) {}
  HWY_INLINE explicit AngleTable(const PolarAngles& angles)
      : r_(hn::Combine(D8(), angles.high.r.raw, angles.low.r.raw)),
        den_(hn::Combine(D8(), angles.high.den.raw, angles.low.den.raw)) {}
  HWY_INLINE Polar<Eight> at(const std::int32_t* angle) const {
    const auto index = hn::SetTableIndices(D8(), angle);
    return {Eight(hn::TableLookupLanes(r_, index)), Eight(hn::TableLookupLanes(den_, index))};
  }

 private:
  hn::Vec<D8> r_, den_;
#else
  HWY_INLINE AngleTable(const float* r, const float* den) {
    std::copy(r, r + FactoredPlan::Steps::kLanes, r_);
    std::copy(den, den + FactoredPlan::Steps::kLanes, den_);
  }
  HWY_INLINE explicit AngleTable(const PolarAngles& angles) {
    hn::StoreU(angles.low.r.raw, D4(), r_);
    hn::StoreU(angles.high.r.raw, D4(), r_ + 4);
    hn::StoreU(angles.low.den.raw, D4(), den_);
    hn::StoreU(angles.high.den.raw, D4(), den_ + 4);
  }
  HWY_INLINE Polar<Eight> at(const std::int32_t* angle) const {
    float r[kEight], den[kEight];
    for (std::size_t i = 0; i < kEight; ++i) {
      r[i] = r_[angle[i]];
      den[i] = den_[angle[i]];
    }
    return {Eight(hn::LoadU(D8(), r)), Eight(hn::LoadU(D8(), den))};
  }

 private:
  float r_[FactoredPlan::Steps::kLanes], den_[FactoredPlan::Steps::kLanes];
#endif
};

/// Finds the polar angles one by one; the remaining lanes are filled up.
HWY_NOINLINE AngleTable angles_apart(const FactoredPlan& plan, const OnePair& one) {
  alignas(32) float r[FactoredPlan::Steps::kLanes], den[FactoredPlan::Steps::kLanes];
  for (std::size_t k = 0; k < FactoredPlan::Steps::kLanes; ++k) {
    Polar<Four> angle{Four(0.0), Four(1.0)};
    if (k < plan.apart.size()) angle = angle_apart(plan.apart[k], one);
    r[k] = hn::GetLane(angle.r.raw);
    den[k] = hn::GetLane(angle.den.raw);
  }
  return AngleTable(r, den);
}

/// Returns the positions of lanes of different spacings: each spacing is computed for all lanes, then chosen.
HWY_INLINE Eight warped(const FactoredPlan::Steps& s, std::size_t lane, const Polar<Eight>& polar,
                        const float* given) {
  using Spacing = FactoredPlan::Spacing;
  const D8 d8;
  const Eight size(hn::Load(d8, s.size.data() + lane)), parameter(hn::Load(d8, s.parameter.data() + lane));
  const auto has = [&](Spacing spacing) HWY_ATTR { return s.has[static_cast<std::size_t>(spacing)]; };
  const auto put = [&](Spacing spacing, Eight value, Eight others) HWY_ATTR {
    const auto is = hn::Load(DI8(), s.is[static_cast<std::size_t>(spacing)].data() + lane);
    return Eight(hn::IfVecThenElse(hn::BitCast(d8, is), value.raw, others.raw));
  };
  Eight position = identity_warp(size, polar);
  if (has(Spacing::root)) position = put(Spacing::root, power_warp(size, Half(), polar), position);
  if (has(Spacing::rational))
    position = put(Spacing::rational, rational_warp(size, parameter, polar), position);
  if (has(Spacing::power)) position = put(Spacing::power, power_warp_apart(size, parameter, polar), position);
  if (has(Spacing::given)) position = put(Spacing::given, Eight(hn::Load(d8, given)), position);
  return position;
}

HWY_INLINE void find_cells(const FactoredPlan& plan, const OnePair& one, const AngleTable& angles,
                           OneCells& cells) {
  const D8 d8;
  alignas(64) float given[OneCells::kMax];
  if (!plan.given.empty()) find_given(plan, one, given);
  AngleTable apart = angles;
  if (!plan.apart.empty()) apart = angles_apart(plan, one);
  // Every lane picks its polar angle, warps it to a position, and splits that into a cell and a fraction.
  std::size_t to = 0;
  for (const FactoredPlan::Steps& s : plan.steps)
    for (std::size_t lane = 0; lane < FactoredPlan::Steps::kLanes; lane += kEight, to += kEight) {
      Polar<Eight> polar = angles.at(s.angle.data() + lane);
      if (s.has_apart) {
        const Polar<Eight> other = apart.at(s.angle.data() + lane);
        const auto is = hn::BitCast(d8, hn::Load(DI8(), s.is_apart.data() + lane));
        polar = {Eight(hn::IfVecThenElse(is, other.r.raw, polar.r.raw)),
                 Eight(hn::IfVecThenElse(is, other.den.raw, polar.den.raw))};
      }
      cells.put(warped(s, lane, polar, given + to), s, lane, to);
    }
}

/// Returns a table's value for one pair. `at`: the axes' lanes.
template <int kAxes>
HWY_INLINE Quad looked_up(const FactoredPlan::Lookup& lookup, const float* rows, const OneCells& cells,
                          const std::array<std::uint32_t, 3>& at) {
  const float* node = rows + cells.floats[at[0]];
  const float x = cells.fraction[at[0]];
  if constexpr (kAxes == 1) return interpolate(node, x);
  if constexpr (kAxes > 1) node += cells.floats[at[1]];
  const std::size_t above = lookup.width * FactoredPlan::kRowStride;
  if constexpr (kAxes == 2) return interpolate(node, node + above, x, cells.fraction[at[1]]);
  if constexpr (kAxes == 3) {
    node += cells.floats[at[2]];
    return interpolate(node, node + above, lookup.layer * FactoredPlan::kRowStride, x, cells.fraction[at[1]],
                       cells.fraction[at[2]]);
  }
}
template <int kAxes>
HWY_INLINE Quad looked_up(const FactoredPlan::Lookup& lookup, const float* rows, const OneCells& cells) {
  const Quad value = looked_up<kAxes>(lookup, rows, cells, lookup.steps_at);
  return lookup.pair ? value * looked_up<kAxes>(lookup, rows, cells, lookup.pair_steps_at) : value;
}

/// Returns three channels: the sum over lobes of scale times lookups [HomomorphicBrdf, eq. 4]. With `weights`, each
/// lobe is multiplied by its weights, of which there are four a lobe.
template <bool kWeighted>
HWY_INLINE Quad sum_of_products(const FactoredPlan& plan, std::size_t group, const OneCells& cells,
                                const float* weights) {
  Quad sum{hn::Zero(D4())};
  const FactoredPlan::Lookup* lookup = plan.lookups.data();
  const float* const values = plan.values.data();
  for (const FactoredPlan::Product& product : plan.products) {
    Quad value = load_quad(product.scale.data() + group * kTogether);
    if constexpr (kWeighted) {
      value = value * load_quad(weights);
      weights += FactoredPlan::kRowStride;
    }
    for (std::size_t k = product.first; k < product.last; ++k, ++lookup) {
      const float* const rows = values + lookup->rows + group * lookup->next_group;
      if (lookup->axes == 1)
        value = value * looked_up<1>(*lookup, rows, cells);
      else if (lookup->axes == 2)
        value = value * looked_up<2>(*lookup, rows, cells);
      else
        value = value * looked_up<3>(*lookup, rows, cells);
    }
    sum = Quad{hn::Add(sum.raw, value.raw)};
  }
  return sum;
}

/// Evaluates one pair. f has the plan's channels; the plan has at most kMaxSteps steps, and with weights (see
/// sum_of_products) at most three channels.
template <bool kWeighted = false>
void eval_one_pair(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, float* f,
                   const float* weights = nullptr) {
  using DI2 = hn::RebindToSigned<D2>;
  const D2 d2;
  const DI2 di2;
  const OnePair one(wi, wo);
  // Both must be unit vectors above the horizon: else the value is not-a-number, or 0 below the horizon.
  const auto excess = hn::LowerHalf(di2, excess_of(one.all.x, one.all.y, one.all.z));
  const auto up = hn::LowerHalf(d2, one.all.z.raw);
  const bool directions = hn::AllFalse(di2, hn::Gt(excess, hn::BitCast(di2, hn::Set(d2, kMaxExcess))));
  if (!directions || !hn::AllTrue(d2, hn::Gt(up, hn::Zero(d2)))) {
    std::fill(f, f + plan.channels, directions ? 0.0f : std::numeric_limits<float>::quiet_NaN());
    return;
  }
  OneCells cells;
  find_cells(plan, one, AngleTable(PolarAngles(plan, one)), cells);
  for (std::size_t group = 0; group * kTogether < plan.channels; ++group, f += kTogether) {
    const auto sum = sum_of_products<kWeighted>(plan, group, cells, weights).raw;
    const std::size_t left = plan.channels - group * kTogether;
    f[0] = hn::GetLane(sum);
    if (left > 1) f[1] = hn::GetLane(hn::Broadcast<1>(sum));
    if (left > 2) f[2] = hn::GetLane(hn::UpperHalf(d2, sum));
  }
}

#endif  // HWY_TARGET != HWY_SCALAR

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
