#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include <burnish/fitting/lobe_lanes.h>
#include <burnish/math/highway_targets.h>
#include <burnish/math/parallel.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "burnish/fitting/lobe_lanes.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#ifndef BURNISH_FITTING_LOBE_LANES
#define BURNISH_FITTING_LOBE_LANES
namespace burnish {
namespace {

constexpr std::size_t kBlock = LobeLanes::kBlock, kLanes = LobeLanes::kLanes,
                      kBlockLanes = LobeLanes::kBlockLanes;

using Slots = std::span<const LobeLanes::Slot>;

}  // namespace
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
namespace burnish {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kLanes>;
using V = hn::Vec<D>;

HWY_INLINE V mix(V a, V b, V t) {
  return hn::MulAdd(t, hn::Sub(b, a), a);
}

// Vectors at a lookup and its neighbour, and their weights.
HWY_INLINE V between(const float* v, V fx) {
  const D d;
  return mix(hn::Load(d, v), hn::Load(d, v + kLanes), fx);
}

template <bool line>
HWY_INLINE V interpolate(const float* v, std::size_t next_row, const Lookups::Place& place) {
  const D d;
  const V fx = hn::Set(d, place.fx), low = between(v, fx);
  if constexpr (line) return low;
  return mix(low, between(v + next_row, fx), hn::Set(d, place.fy));
}

// Adds `amount` times an interpolation's weights.
HWY_INLINE void add_between(V amount, V fx, float* v) {
  const D d;
  const V second = hn::Mul(fx, amount);
  hn::Store(hn::Add(hn::Load(d, v), hn::Sub(amount, second)), d, v);
  hn::Store(hn::Add(hn::Load(d, v + kLanes), second), d, v + kLanes);
}

template <bool line>
HWY_INLINE void add_weights(V amount, const Lookups::Place& place, std::size_t next_row, float* v) {
  const D d;
  const V fx = hn::Set(d, place.fx);
  if constexpr (line) {
    add_between(amount, fx, v);
  } else {
    const V high = hn::Mul(amount, hn::Set(d, place.fy));
    add_between(hn::Sub(amount, high), fx, v);
    add_between(high, fx, v + next_row);
  }
}

// The same with the squares of the weights.
HWY_INLINE void add_squares_between(V amount, float fx, float* v) {
  const D d;
  const V first = hn::Set(d, (1 - fx) * (1 - fx)), second = hn::Set(d, fx * fx);
  hn::Store(hn::MulAdd(amount, first, hn::Load(d, v)), d, v);
  hn::Store(hn::MulAdd(amount, second, hn::Load(d, v + kLanes)), d, v + kLanes);
}

template <bool line>
HWY_INLINE void add_square_weights(V amount, const Lookups::Place& place, std::size_t next_row, float* v) {
  const D d;
  const auto times = [&](float w) { return hn::Mul(amount, hn::Set(d, w * w)); };
  add_squares_between(line ? amount : times(1 - place.fy), place.fx, v);
  if constexpr (!line) add_squares_between(times(place.fy), place.fx, v + next_row);
}

HWY_INLINE V reciprocal(V v) {
  const V guess = hn::ApproximateReciprocal(v);
  return hn::Mul(guess, hn::NegMulAdd(v, guess, hn::Set(D(), 2.0f)));  // a step of Newton's
}

// visit(slot, number of the slot, is a line)
template <class Visit>
HWY_INLINE void for_each_slot(Slots slots, Visit visit) {
  for (std::size_t s = 0; s < slots.size(); ++s)
    if (slots[s].next_row == 0)
      visit(slots[s], s, std::true_type());
    else
      visit(slots[s], s, std::false_type());
}

// visit(pair of the block, lane, number of the lane in the block)
template <class Visit>
HWY_INLINE void for_each_vector(Visit visit) {
  for (std::size_t i = 0; i < kBlock; ++i)
    for (std::size_t l = 0; l < kLanes; l += hn::Lanes(D())) visit(i, l, i * kLanes + l);
}

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

// `products` hold the lobes' scales, 0 where there is none.
void evaluate(Slots slots, std::size_t parts, const Lookups::Place* places, const float* values,
              float* factors, float* products, float* totals) {
  const D d;
  for_each_slot(slots, [&](const LobeLanes::Slot& slot, std::size_t s, auto line) HWY_ATTR {
    const Lookups::Place* place = places + slot.place * kBlock;
    const float* from = values + slot.base;
    float *factor_of = factors + s * kBlockLanes, *product_of = products + slot.part * kBlockLanes;
    const std::size_t next_row = slot.next_row;
    for_each_vector([=](std::size_t i, std::size_t l, std::size_t at) HWY_ATTR {
      const V factor = interpolate<line>(from + place[i].node * kLanes + l, next_row, place[i]);
      hn::Store(factor, d, factor_of + at);
      hn::Store(hn::Mul(hn::Load(d, product_of + at), factor), d, product_of + at);
    });
  });
  sum_lanes(parts, products, totals);
}

void differentiate(Slots slots, std::size_t parts, const float* totals, float* factors, float* products) {
  const D d;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const V over = hn::Set(d, 1 / totals[i]);
    for (std::size_t p = 0; p < parts; ++p)
      for (std::size_t l = 0; l < kLanes; l += hn::Lanes(d)) {
        float* product = products + p * kBlockLanes + i * kLanes + l;
        hn::Store(hn::Mul(hn::Load(d, product), over), d, product);
      }
  }
  for_each_slot(slots, [&](const LobeLanes::Slot& slot, std::size_t s, auto) HWY_ATTR {
    float* factor = factors + s * kBlockLanes;
    const float* share = products + slot.part * kBlockLanes;
    for_each_vector([=](std::size_t, std::size_t, std::size_t at) HWY_ATTR {
      hn::Store(hn::Mul(hn::Load(d, share + at), reciprocal(hn::Load(d, factor + at))), d, factor + at);
    });
  });
  for (std::size_t s = 0; s < slots.size(); ++s) {
    if (!slots[s].one_table) continue;
    float* factor = factors + s * kBlockLanes;
    for (std::size_t i = 0; i < kBlock; ++i, factor += kLanes) {
      float sum = 0;
      for (std::size_t l = 0; l < kLanes; ++l) sum += std::exchange(factor[l], 0.0f);
      factor[0] = sum;
    }
  }
}

void add_transposed(Slots slots, const Lookups::Place* places, const float* slopes, const float* amounts,
                    float* sums) {
  const D d;
  for_each_slot(slots, [&](const LobeLanes::Slot& slot, std::size_t s, auto line) HWY_ATTR {
    const Lookups::Place* place = places + slot.place * kBlock;
    const float* slope = slopes + s * kBlockLanes;
    float* into = sums + slot.base;
    const std::size_t next_row = slot.next_row;
    for_each_vector([=](std::size_t i, std::size_t l, std::size_t at) HWY_ATTR {
      add_weights<line>(hn::Mul(hn::Set(d, amounts[i]), hn::Load(d, slope + at)), place[i], next_row,
                        into + place[i].node * kLanes + l);
    });
  });
}

void add_squares(Slots slots, const Lookups::Place* places, const float* slopes, const float* amounts,
                 float* sums) {
  const D d;
  for_each_slot(slots, [&](const LobeLanes::Slot& slot, std::size_t s, auto line) HWY_ATTR {
    const Lookups::Place* place = places + slot.place * kBlock;
    const float* slopes_of = slopes + s * kBlockLanes;
    float* into = sums + slot.base;
    const std::size_t next_row = slot.next_row;
    for_each_vector([=](std::size_t i, std::size_t l, std::size_t at) HWY_ATTR {
      const V slope = hn::Load(d, slopes_of + at);
      add_square_weights<line>(hn::Mul(hn::Set(d, amounts[i]), hn::Mul(slope, slope)), place[i], next_row,
                               into + place[i].node * kLanes + l);
    });
  });
}

// Adds J^T J v of a block to `sums`; `slopes` is room.
void multiply(Slots slots, const Lookups::Place* places, const float* values, const float* shares,
              const float* v, float* slopes, float* sums) {
  const D d;
  HWY_ALIGN float products[kBlockLanes] = {};
  float amounts[kBlock];
  for_each_slot(slots, [&](const LobeLanes::Slot& slot, std::size_t s, auto line) HWY_ATTR {
    const Lookups::Place* place = places + slot.place * kBlock;
    const float *value = values + slot.base, *from = v + slot.base, *share = shares + slot.part * kBlockLanes;
    float *slope_of = slopes + s * kBlockLanes, *product = products;
    const std::size_t next_row = slot.next_row;
    for_each_vector([=](std::size_t i, std::size_t l, std::size_t at) HWY_ATTR {
      const std::size_t node = place[i].node * kLanes + l;
      const V over = reciprocal(interpolate<line>(value + node, next_row, place[i]));
      const V slope = hn::Mul(hn::Load(d, share + at), over);
      hn::Store(slope, d, slope_of + at);
      hn::Store(
          hn::MulAdd(slope, interpolate<line>(from + node, next_row, place[i]), hn::Load(d, product + at)), d,
          product + at);
    });
  });
  sum_lanes(1, products, amounts);
  add_transposed(slots, places, slopes, amounts, sums);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace burnish
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(evaluate);
HWY_EXPORT(differentiate);
HWY_EXPORT(add_transposed);
HWY_EXPORT(add_squares);
HWY_EXPORT(multiply);

constexpr std::size_t kMostGroups = 16;
constexpr float kLeastTotal = 1e-30f;  // whose reciprocal is finite

void prefetch(const void* data, std::size_t bytes) noexcept {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < bytes; at += kLine) hwy::Prefetch(static_cast<const std::byte*>(data) + at);
}

}  // namespace

LobeLanes::LobeLanes(std::span<const Unknowns> tables, const Lookups& lookups, std::size_t channels)
    : lookups_(lookups),
      channels_(channels),
      parts_(chunk_count(lookups.lobes.size(), kLanes)),
      tables_(tables.begin(), tables.end()) {
  // The tables of each slot, lobe by lobe.
  std::vector<std::vector<std::size_t>> lanes;
  for (std::size_t j = 0; j < lookups.lobes.size(); ++j)
    for (const std::size_t k : lookups.lobes[j]) {
      std::size_t s = 0;
      while (s < slots_.size() && (slots_[s].part != j / kLanes || slots_[s].place != lookups.place_of[k] ||
                                   lanes[s][j % kLanes] != kNone))
        ++s;
      if (s == slots_.size()) {
        slots_.push_back({.place = lookups.place_of[k], .part = j / kLanes});
        lanes.emplace_back(kLanes, kNone);
      }
      lanes[s][j % kLanes] = static_cast<std::size_t>(lookups.lookups[k].table);
    }
  std::vector<std::size_t> nodes;  // of the families
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    Slot& slot = slots_[s];
    const auto table = *std::ranges::find_if(lanes[s], [](std::size_t t) { return t != kNone; });
    const TableLayout& layout = tables[table].layout;
    const std::size_t lobes_of_part = std::min(kLanes, lookups.lobes.size() - slot.part * kLanes);
    slot.one_table = std::ranges::count(lanes[s], table) == static_cast<std::ptrdiff_t>(lobes_of_part);
    const auto known = std::ranges::find_if(families_, [&](const Family& family) {
      return family.tables == lanes[s] && family.one_table == slot.one_table;
    });
    slot.family = static_cast<std::size_t>(known - families_.begin());
    if (known == families_.end()) {
      families_.push_back({.tables = lanes[s], .one_table = slot.one_table, .base = channel_size_});
      nodes.push_back(layout.node_count());
      channel_size_ += layout.node_count() * kLanes;
    }
    slot.base = families_[slot.family].base;
    slot.next_row = layout.shape == TableShape::line ? 0 : static_cast<std::size_t>(layout.width) * kLanes;
  }
  for (std::size_t f = 0; f < families_.size(); ++f)
    for (std::size_t l = 0; l < kLanes; ++l) {
      if (families_[f].tables[l] == kNone) continue;
      const auto& [base, stride, copies, layout] = tables[families_[f].tables[l]];
      for (std::size_t n = 0; n < nodes[f]; ++n)
        for (std::size_t c = 0; c < channels; ++c)
          links_.push_back(
              {static_cast<std::uint32_t>(base + n * stride + (copies > 1 ? c : 0)),
               static_cast<std::uint32_t>(c * channel_size_ + families_[f].base + n * kLanes + l)});
    }
}

AlignedVector<float> LobeLanes::spread(const Eigen::VectorXd& v, float empty) const {
  AlignedVector<float> lanes(channels_ * channel_size_, empty);
  for (const auto& [unknown, value] : links_)
    lanes[value] = static_cast<float>(v[static_cast<Eigen::Index>(unknown)]);
  return lanes;
}

LobeLanes::Values LobeLanes::values(const Eigen::VectorXd& x) const {
  Values found{.lambda = x, .lambdas = {}, .scales = AlignedVector<float>(channels_ * parts_ * kLanes)};
  std::vector<double> means(tables_.size() * channels_);
  for (std::size_t t = 0; t < tables_.size(); ++t) {
    const auto& [base, stride, copies, layout] = tables_[t];
    const auto nodes = static_cast<Eigen::Index>(layout.node_count());
    for (std::size_t c = 0; c < channels_; ++c) {
      Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>> logs(
          found.lambda.data() + base + (copies > 1 ? c : 0), nodes,
          Eigen::InnerStride<>(static_cast<Eigen::Index>(stride)));
      if (c > 0 && copies == 1) {
        means[t * channels_ + c] = means[t * channels_];
        continue;
      }
      const double mean = means[t * channels_ + c] = logs.mean();
      logs.array() -= mean;
    }
  }
  found.lambda = found.lambda.array().exp();
  found.lambdas = spread(found.lambda, 1);
  for (std::size_t c = 0; c < channels_; ++c)
    for (std::size_t j = 0; j < lookups_.lobes.size(); ++j) {
      double sum = 0;
      for (const std::size_t k : lookups_.lobes[j])
        sum += means[static_cast<std::size_t>(lookups_.lookups[k].table) * channels_ + c];
      found.scales[c * parts_ * kLanes + j] = static_cast<float>(std::exp(sum));
    }
  return found;
}

void LobeLanes::gather(const AlignedVector<float>& lanes, Eigen::VectorXd& v) const {
  for (const auto& [unknown, value] : links_)
    v[static_cast<Eigen::Index>(unknown)] += static_cast<double>(lanes[value]);
}

LobeLanes::Block LobeLanes::block() const {
  return {.factor = AlignedVector<float>(slots_.size() * kBlockLanes),
          .product = AlignedVector<float>(parts_ * kBlockLanes),
          .total = AlignedVector<float>(kBlock)};
}

void LobeLanes::evaluate(const Values& values, std::size_t block, std::size_t channel,
                         Block& at) const noexcept {
  for (std::size_t p = 0; p < parts_; ++p) {
    const float* scales = values.scales.data() + (channel * parts_ + p) * kLanes;
    for (std::size_t i = 0; i < kBlock; ++i)
      std::copy_n(scales, kLanes, at.product.data() + p * kBlockLanes + i * kLanes);
  }
  HWY_DYNAMIC_DISPATCH(evaluate)
  (slots_, parts_, places(block), values.lambdas.data() + channel * channel_size_, at.factor.data(),
   at.product.data(), at.total.data());
  for (float& total : at.total) total = std::max(total, kLeastTotal);
}

void LobeLanes::differentiate(Block& at) const noexcept {
  HWY_DYNAMIC_DISPATCH(differentiate)
  (slots_, parts_, at.total.data(), at.factor.data(), at.product.data());
}

void LobeLanes::add_transposed(const Block& at, const float* amounts, std::size_t block, std::size_t channel,
                               AlignedVector<float>& sums) const noexcept {
  HWY_DYNAMIC_DISPATCH(add_transposed)
  (slots_, places(block), at.factor.data(), amounts, sums.data() + channel * channel_size_);
}

void LobeLanes::add_squares(const Block& at, const float* amounts, std::size_t block, std::size_t channel,
                            AlignedVector<float>& sums) const noexcept {
  HWY_DYNAMIC_DISPATCH(add_squares)
  (slots_, places(block), at.factor.data(), amounts, sums.data() + channel * channel_size_);
}

Eigen::VectorXd LobeLanes::times(const Values& values, const AlignedVector<float>& shares,
                                 const Eigen::VectorXd& v) const {
  const AlignedVector<float> lanes = spread(v, 0);
  const std::size_t group_size = (blocks() + kMostGroups - 1) / kMostGroups;
  std::vector<AlignedVector<float>> partial(chunk_count(blocks(), group_size));
  for_each_chunk(blocks(), group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    partial[group].resize(lanes.size());
    AlignedVector<float> slopes(slots_.size() * kBlockLanes);
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t c = 0; c < channels_; ++c) {
        if (b + 1 < end) {  // many short streams: too short for the processor to foresee
          if (c == 0) prefetch(places(b + 1), kBlock * lookups_.place_count * sizeof(Lookups::Place));
          prefetch(shares.data() + ((b + 1) * channels_ + c) * shares_of_block(),
                   shares_of_block() * sizeof(float));
        }
        const std::size_t offset = c * channel_size_;
        HWY_DYNAMIC_DISPATCH(multiply)
        (slots_, places(b), values.lambdas.data() + offset,
         shares.data() + (b * channels_ + c) * shares_of_block(), lanes.data() + offset, slopes.data(),
         partial[group].data() + offset);
      }
  });
  AlignedVector<float>& sum = partial.front();
  for (std::size_t g = 1; g < partial.size(); ++g)
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += partial[g][k];
  Eigen::VectorXd product = Eigen::VectorXd::Zero(v.size());
  gather(sum, product);
  return product;
}

}  // namespace burnish
#endif
