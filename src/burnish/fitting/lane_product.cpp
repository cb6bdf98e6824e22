#include <algorithm>

#include <burnish/fitting/lane_product.h>
#include <burnish/math/highway_targets.h>
#include <burnish/math/parallel.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "burnish/fitting/lane_product.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#ifndef BURNISH_FITTING_LANE_ROWS
#define BURNISH_FITTING_LANE_ROWS
namespace burnish {
namespace {

constexpr std::size_t kBlock = Lookups::kBlock;
constexpr std::size_t kLanes = 8;  // tables of a family at most

// What the kernels of all targets take.
struct LaneRows {
  std::span<const LaneProduct::Group> groups;
  const Lookups::Place* places;
  const float* slopes;
  std::size_t place_count, slots, channels;
};

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
  return mix(hn::LoadU(d, v), hn::LoadU(d, v + kLanes), fx);
}

HWY_INLINE void add_between(V amount, V fx, float* v) {
  const D d;
  const V second = hn::Mul(fx, amount);
  hn::StoreU(hn::Add(hn::LoadU(d, v), hn::Sub(amount, second)), d, v);
  hn::StoreU(hn::Add(hn::LoadU(d, v + kLanes), second), d, v + kLanes);
}

HWY_INLINE float between(const float* v, float fx) {
  return v[0] + fx * (v[1] - v[0]);
}

HWY_INLINE void add_between(float amount, float fx, float* v) {
  const float second = fx * amount;
  v[0] += amount - second;
  v[1] += second;
}

// Adds the products of a block's rows and `values`, over one group's lookups.
template <bool line>
void add_products(const LaneProduct::Group& group, const Lookups::Place* places, const float* slopes,
                  const float* values, float* sums) {
  const D d;
  const std::size_t next_row = group.next_row, lanes = group.lanes;
  if (lanes == 1) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const auto [node, fx, fy] = places[i];
      float value = between(values + node, fx);
      if constexpr (!line) value += fy * (between(values + node + next_row, fx) - value);
      sums[i * kLanes] += slopes[i] * value;
    }
    return;
  }
  for (std::size_t i = 0; i < kBlock; ++i)
    for (std::size_t l = 0; l < kLanes; l += hn::Lanes(d)) {
      const auto [node, x, y] = places[i];
      const float* low = values + node * kLanes + l;
      const V fx = hn::Set(d, x);
      V value = between(low, fx);
      if constexpr (!line) value = mix(value, between(low + next_row, fx), hn::Set(d, y));
      float* sum = sums + i * kLanes + l;
      hn::Store(hn::MulAdd(hn::LoadU(d, slopes + i * lanes + l), value, hn::Load(d, sum)), d, sum);
    }
}

// Adds the block's rows times `amounts` to `values`, over one group's lookups.
template <bool line>
void add_transposed(const LaneProduct::Group& group, const Lookups::Place* places, const float* slopes,
                    const float* amounts, float* values) {
  const D d;
  const std::size_t next_row = group.next_row, lanes = group.lanes;
  if (lanes == 1) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const auto [node, fx, fy] = places[i];
      const float all = amounts[i] * slopes[i], high = line ? 0 : fy * all;
      add_between(all - high, fx, values + node);
      if constexpr (!line) add_between(high, fx, values + node + next_row);
    }
    return;
  }
  for (std::size_t i = 0; i < kBlock; ++i)
    for (std::size_t l = 0; l < kLanes; l += hn::Lanes(d)) {
      const auto [node, x, y] = places[i];
      float* low = values + node * kLanes + l;
      const V fx = hn::Set(d, x);
      const V all = hn::Mul(hn::Set(d, amounts[i]), hn::LoadU(d, slopes + i * lanes + l));
      if constexpr (line) {
        add_between(all, fx, low);
      } else {
        const V high = hn::Mul(hn::Set(d, y), all);
        add_between(hn::Sub(all, high), fx, low);
        add_between(high, fx, low + next_row);
      }
    }
}

// Adds J^T J v of the blocks [begin, end) to `sum`.
void multiply(const LaneRows& rows, std::size_t begin, std::size_t end, const float* v, float* sum) {
  const D d;
  HWY_ALIGN float sums[kBlock * kLanes];
  float amounts[kBlock];
  for (std::size_t block = begin; block < end; ++block)
    for (std::size_t c = 0; c < rows.channels; ++c) {
      const Lookups::Place* places = rows.places + block * rows.place_count * kBlock;
      const float* slopes = rows.slopes + (block * rows.channels + c) * rows.slots * kBlock;
      std::fill_n(sums, kBlock * kLanes, 0.0f);
      for (const LaneProduct::Group& group : rows.groups)
        (group.next_row == 0 ? add_products<true>
                             : add_products<false>)(group, places + group.place * kBlock,
                                                    slopes + group.slot * kBlock,
                                                    v + group.base + c * group.channel_stride, sums);
      for (std::size_t i = 0; i < kBlock; ++i) {
        V total = hn::Zero(d);
        for (std::size_t l = 0; l < kLanes; l += hn::Lanes(d))
          total = hn::Add(total, hn::Load(d, sums + i * kLanes + l));
        amounts[i] = hn::GetLane(hn::SumOfLanes(d, total));
      }
      for (const LaneProduct::Group& group : rows.groups)
        (group.next_row == 0 ? add_transposed<true>
                             : add_transposed<false>)(group, places + group.place * kBlock,
                                                      slopes + group.slot * kBlock, amounts,
                                                      sum + group.base + c * group.channel_stride);
    }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace burnish
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(multiply);

constexpr std::size_t kMostGroups = 16;

// Tables of one layout.
struct Family {
  std::size_t first, count;  // its first table
  std::size_t base, size;    // of one copy's values
};

}  // namespace

LaneProduct::LaneProduct(std::span<const Unknowns> tables, const Lookups& lookups, std::size_t channels)
    : lookups_(lookups), channels_(channels) {
  std::vector<Family> families;
  std::vector<std::size_t> family_of, lane_of;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const auto fits = [&](const Family& family) {
      return family.count < kLanes && tables[family.first].layout == tables[t].layout &&
             tables[family.first].copies == tables[t].copies;
    };
    const auto family = std::ranges::find_if(families, fits);
    family_of.push_back(static_cast<std::size_t>(family - families.begin()));
    if (family == families.end()) families.push_back({.first = t, .count = 0, .base = 0, .size = 0});
    lane_of.push_back(families[family_of[t]].count++);
  }
  for (Family& family : families) {
    const Unknowns& table = tables[family.first];
    family.base = values_;
    family.size = table.layout.node_count() * (family.count > 1 ? kLanes : 1);
    values_ += family.size * table.copies;
  }
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const auto& [base, stride, copies, layout] = tables[t];
    const Family& family = families[family_of[t]];
    const std::size_t step = family.count > 1 ? kLanes : 1;
    value_of_.resize(std::max(value_of_.size(), base + layout.node_count() * copies));
    for (std::size_t n = 0; n < layout.node_count(); ++n)
      for (std::size_t c = 0; c < copies; ++c)
        value_of_[base + n * stride + c] =
            static_cast<std::uint32_t>(family.base + c * family.size + n * step + lane_of[t]);
  }
  std::vector<std::size_t> group_family;
  for (std::size_t k = 0; k < lookups.lookups.size(); ++k) {
    const auto t = static_cast<std::size_t>(lookups.lookups[k].table);
    const Family& family = families[family_of[t]];
    std::size_t g = 0;
    while (g < groups_.size() && (group_family[g] != family_of[t] || groups_[g].place != lookups.place_of[k]))
      ++g;
    if (g == groups_.size()) {
      const TableLayout& layout = tables[t].layout;
      const bool alone = family.count == 1, line = layout.shape == TableShape::line;
      groups_.push_back({.base = family.base,
                         .channel_stride = tables[t].copies > 1 ? family.size : 0,
                         .next_row = line ? 0 : static_cast<std::size_t>(layout.width) * (alone ? 1 : kLanes),
                         .place = lookups.place_of[k],
                         .slot = slots_,
                         .lanes = family.count});
      group_family.push_back(family_of[t]);
      slots_ += family.count;
    }
    slot_.push_back({g, lane_of[t]});
  }
}

// Pairs that fill up the last block have slopes of 0. Vectors read beyond a row's lanes: the values there are
// 0, and so are products; the sums there are asked for by none.
std::vector<float> LaneProduct::slopes() const {
  const std::size_t rows = chunk_count(lookups_.pairs, kBlock) * kBlock * channels_;
  return std::vector<float>(rows * slots_ + kLanes);
}

Eigen::VectorXd LaneProduct::times(const std::vector<float>& slopes, const Eigen::VectorXd& v) const {
  std::vector<float> values(values_);
  for (std::size_t u = 0; u < value_of_.size(); ++u)
    values[value_of_[u]] = static_cast<float>(v[static_cast<Eigen::Index>(u)]);
  const LaneRows rows{.groups = groups_,
                      .places = lookups_.places.data(),
                      .slopes = slopes.data(),
                      .place_count = lookups_.place_count,
                      .slots = slots_,
                      .channels = channels_};
  const std::size_t count = chunk_count(lookups_.pairs, kBlock);
  const std::size_t group_size = (count + kMostGroups - 1) / kMostGroups;
  std::vector<std::vector<float>> partial(chunk_count(count, group_size));
  for_each_chunk(count, group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    partial[group].resize(values_);
    HWY_DYNAMIC_DISPATCH(multiply)(rows, begin, end, values.data(), partial[group].data());
  });
  Eigen::VectorXd product = Eigen::VectorXd::Zero(v.size());
  for (const std::vector<float>& sum : partial)
    for (std::size_t u = 0; u < value_of_.size(); ++u)
      product[static_cast<Eigen::Index>(u)] += static_cast<double>(sum[value_of_[u]]);
  return product;
}

}  // namespace burnish
#endif
