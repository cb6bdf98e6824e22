// SPDX-License-Identifier: Apache-2.0
// Per-target include: a block of pairs by the lobes of a model.
#if defined(BURNISH_FITTING_LOBE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_FITTING_LOBE_LANES_INL_H_
#undef BURNISH_FITTING_LOBE_LANES_INL_H_
#else
#define BURNISH_FITTING_LOBE_LANES_INL_H_
#endif

#include <span>
#include <type_traits>
#include <utility>

#include <burnish/math/highway-inl.h>

#include <burnish/fitting/refinement/lobe_lanes.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

constexpr std::size_t kLanes = LobeLanes::kLanes;
using D = hn::CappedTag<float, kLanes>;
using V = hn::Vec<D>;
using Slots = std::span<const LobeLanes::Slot>;

constexpr std::size_t kBlock = LobeLanes::kBlock, kBlockLanes = LobeLanes::kBlockLanes;

// Interpolates linearly: a + t (b - a).
HWY_INLINE V mix(V a, V b, V t) {
  return hn::MulAdd(t, hn::Sub(b, a), a);
}

// Interpolates between the vectors at a lookup's node and its neighbour along x.
HWY_INLINE V between(const float* v, V fx) {
  const D d;
  return mix(hn::Load(d, v), hn::Load(d, v + kLanes), fx);
}

// Floats from a lookup's node to the next row and layer; 0 where a table has none.
struct Strides {
  std::size_t row, layer;
};

HWY_INLINE Strides strides_of(const LobeLanes::Slot& slot) {
  return {slot.next_row, slot.next_layer};
}

// Interpolates linearly along 1, 2 or 3 axes.
template <int axes>
HWY_INLINE V interpolate(const float* v, Strides next, const Lookups::Place& place) {
  const D d;
  if constexpr (axes == 3) {
    const V low = interpolate<2>(v, next, place);
    return mix(low, interpolate<2>(v + next.layer, next, place), hn::Set(d, place.fz));
  } else {
    const V fx = hn::Set(d, place.fx), low = between(v, fx);
    if constexpr (axes == 1) return low;
    return mix(low, between(v + next.row, fx), hn::Set(d, place.fy));
  }
}

// Adds `amount` times the weights of linear interpolation along x: the transpose of between().
HWY_INLINE void add_between(V amount, V fx, float* v) {
  const D d;
  const V second = hn::Mul(fx, amount);
  hn::Store(hn::Add(hn::Load(d, v), hn::Sub(amount, second)), d, v);
  hn::Store(hn::Add(hn::Load(d, v + kLanes), second), d, v + kLanes);
}

// Adds `amount` times the weights along all axes: the transpose of interpolate().
template <int axes>
HWY_INLINE void add_weights(V amount, const Lookups::Place& place, Strides next, float* v) {
  const D d;
  if constexpr (axes == 3) {
    const V high = hn::Mul(amount, hn::Set(d, place.fz));
    add_weights<2>(hn::Sub(amount, high), place, next, v);
    add_weights<2>(high, place, next, v + next.layer);
  } else {
    const V fx = hn::Set(d, place.fx);
    if constexpr (axes == 1) {
      add_between(amount, fx, v);
    } else {
      const V high = hn::Mul(amount, hn::Set(d, place.fy));
      add_between(hn::Sub(amount, high), fx, v);
      add_between(high, fx, v + next.row);
    }
  }
}

// Adds `amount` times the squares of the weights along x.
HWY_INLINE void add_squares_between(V amount, float fx, float* v) {
  const D d;
  const V first = hn::Set(d, (1 - fx) * (1 - fx)), second = hn::Set(d, fx * fx);
  hn::Store(hn::MulAdd(amount, first, hn::Load(d, v)), d, v);
  hn::Store(hn::MulAdd(amount, second, hn::Load(d, v + kLanes)), d, v + kLanes);
}

// Adds `amount` times the squares of the weights along all axes.
template <int axes>
HWY_INLINE void add_square_weights(V amount, const Lookups::Place& place, Strides next, float* v) {
  const D d;
  const auto times = [&](float w) { return hn::Mul(amount, hn::Set(d, w * w)); };
  if constexpr (axes == 3) {
    add_square_weights<2>(times(1 - place.fz), place, next, v);
    add_square_weights<2>(times(place.fz), place, next, v + next.layer);
  } else {
    add_squares_between(axes == 1 ? amount : times(1 - place.fy), place.fx, v);
    if constexpr (axes == 2) add_squares_between(times(place.fy), place.fx, v + next.row);
  }
}

HWY_INLINE V reciprocal(V v) {
  const V guess = hn::ApproximateReciprocal(v);
  return hn::Mul(guess, hn::NegMulAdd(v, guess, hn::Set(D(), 2.0f)));  // one Newton step
}

// Calls visit(slot, number of the slot, its axes).
template <class Visit>
HWY_INLINE void for_each_slot(Slots slots, Visit visit) {
  for (std::size_t s = 0; s < slots.size(); ++s)
    if (slots[s].next_row == 0)
      visit(slots[s], s, std::integral_constant<int, 1>());
    else if (slots[s].next_layer == 0)
      visit(slots[s], s, std::integral_constant<int, 2>());
    else
      visit(slots[s], s, std::integral_constant<int, 3>());
}

// Calls visit(pair of the block, lane, number of the lane in the block).
template <class Visit>
HWY_INLINE void for_each_vector(Visit visit) {
  for (std::size_t i = 0; i < kBlock; ++i)
    for (std::size_t l = 0; l < kLanes; l += hn::Lanes(D())) visit(i, l, i * kLanes + l);
}

// Sums each pair's lanes over all parts of the lobes.
void sum_lanes(std::size_t parts, const float* lanes, float* sums) {
  const D d;
  for (std::size_t i = 0; i < kBlock; ++i) {
    V sum = hn::Zero(d);
    for (std::size_t p = 0; p < parts; ++p)
      for (std::size_t l = 0; l < kLanes; l += hn::Lanes(d))
        sum = hn::Add(sum, hn::Load(d, lanes + p * kBlockLanes + i * kLanes + l));
    sums[i] = hn::GetLane(hn::SumOfLanes(d, sum));
  }
}

// Looks up every slot and multiplies its lobes' products, which begin as the lobes' scales (0: no lobe). The totals
// are f^, the sums of the products [HomomorphicBrdf, eq. 4].
void evaluate(Slots slots, std::size_t parts, const Lookups::Place* places, const float* values,
              float* factors, float* products, float* totals) {
  const D d;
  for_each_slot(slots, [&](const LobeLanes::Slot& slot, std::size_t s, auto axes) HWY_ATTR {
    const Lookups::Place* place = places + slot.place * kBlock;
    const float* from = values + slot.base;
    float *factor_of = factors + s * kBlockLanes, *product_of = products + slot.part * kBlockLanes;
    const Strides next = strides_of(slot);
    for_each_vector([=](std::size_t i, std::size_t l, std::size_t at) HWY_ATTR {
      // One interpolation serves all lobes of the part: they are the lanes.
      const V factor = interpolate<axes>(from + place[i].node * kLanes + l, next, place[i]);
      hn::Store(factor, d, factor_of + at);
      hn::Store(hn::Mul(hn::Load(d, product_of + at), factor), d, product_of + at);
    });
  });
  sum_lanes(parts, products, totals);
}

void differentiate(Slots slots, std::size_t parts, const float* totals, float* factors, float* products) {
  const D d;
  for (std::size_t i = 0; i < kBlock; ++i) {
    // A lobe's share is its product over the total: d ln f^ / d ln(product).
    const V over = hn::Set(d, 1 / totals[i]);
    for (std::size_t p = 0; p < parts; ++p)
      for (std::size_t l = 0; l < kLanes; l += hn::Lanes(d)) {
        float* product = products + p * kBlockLanes + i * kLanes + l;
        hn::Store(hn::Mul(hn::Load(d, product), over), d, product);
      }
  }
  for_each_slot(slots, [&](const LobeLanes::Slot& slot, std::size_t s, auto) HWY_ATTR {
    // A factor lambda changes ln f^ by share / lambda.
    float* factor = factors + s * kBlockLanes;
    const float* share = products + slot.part * kBlockLanes;
    for_each_vector([=](std::size_t, std::size_t, std::size_t at) HWY_ATTR {
      hn::Store(hn::Mul(hn::Load(d, share + at), reciprocal(hn::Load(d, factor + at))), d, factor + at);
    });
  });
  for (std::size_t s = 0; s < slots.size(); ++s) {
    // If all lanes share one table, the sum of their slopes is the table's.
    if (!slots[s].one_table) continue;
    float* factor = factors + s * kBlockLanes;
    for (std::size_t i = 0; i < kBlock; ++i, factor += kLanes) {
      float sum = 0;
      for (std::size_t l = 0; l < kLanes; ++l) sum += std::exchange(factor[l], 0.0f);
      factor[0] = sum;
    }
  }
}

// Adds to each node amount * slope * weight, or amount * (slope * weight)^2 if `squares`.
template <bool squares>
void add_terms(Slots slots, const Lookups::Place* places, const float* slopes, const float* amounts,
               float* sums) {
  const D d;
  for_each_slot(slots, [&](const LobeLanes::Slot& slot, std::size_t s, auto axes) HWY_ATTR {
    const Lookups::Place* place = places + slot.place * kBlock;
    const float* slopes_of = slopes + s * kBlockLanes;
    float* into = sums + slot.base;
    const Strides next = strides_of(slot);
    for_each_vector([=](std::size_t i, std::size_t l, std::size_t at) HWY_ATTR {
      const V slope = hn::Load(d, slopes_of + at), amount = hn::Set(d, amounts[i]);
      float* to = into + place[i].node * kLanes + l;
      if constexpr (squares)
        add_square_weights<axes>(hn::Mul(amount, hn::Mul(slope, slope)), place[i], next, to);
      else
        add_weights<axes>(hn::Mul(amount, slope), place[i], next, to);
    });
  });
}

void add_transposed(Slots slots, const Lookups::Place* places, const float* slopes, const float* amounts,
                    float* sums) {
  add_terms<false>(slots, places, slopes, amounts, sums);
}

void add_squares(Slots slots, const Lookups::Place* places, const float* slopes, const float* amounts,
                 float* sums) {
  add_terms<true>(slots, places, slopes, amounts, sums);
}

// Adds J^T J v of a block to `sums`; `slopes` is room. The row times v is the sum of slope times v's interpolation.
void multiply(Slots slots, const Lookups::Place* places, const float* values, const float* shares,
              const float* v, float* slopes, float* sums) {
  const D d;
  HWY_ALIGN float products[kBlockLanes] = {};
  float amounts[kBlock];
  for_each_slot(slots, [&](const LobeLanes::Slot& slot, std::size_t s, auto axes) HWY_ATTR {
    const Lookups::Place* place = places + slot.place * kBlock;
    const float *value = values + slot.base, *from = v + slot.base, *share = shares + slot.part * kBlockLanes;
    float *slope_of = slopes + s * kBlockLanes, *product = products;
    const Strides next = strides_of(slot);
    for_each_vector([=](std::size_t i, std::size_t l, std::size_t at) HWY_ATTR {
      const std::size_t node = place[i].node * kLanes + l;
      const V over = reciprocal(interpolate<axes>(value + node, next, place[i]));
      // The slope is share / factor, and v's interpolation is the directional change of the factor.
      const V slope = hn::Mul(hn::Load(d, share + at), over);
      hn::Store(slope, d, slope_of + at);
      hn::Store(hn::MulAdd(slope, interpolate<axes>(from + node, next, place[i]), hn::Load(d, product + at)),
                d, product + at);
    });
  });
  sum_lanes(1, products, amounts);
  add_transposed(slots, places, slopes, amounts, sums);
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
