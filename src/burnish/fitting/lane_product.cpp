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

// Adds the lanes (1 - t) v and t v to the two neighbours.
HWY_INLINE void add_split(V v, V t, float* at) {
  const D d;
  const V second = hn::Mul(t, v);
  hn::StoreU(hn::Add(hn::LoadU(d, at), hn::Sub(v, second)), d, at);
  hn::StoreU(hn::Add(hn::LoadU(d, at + kLanes), second), d, at + kLanes);
}

HWY_INLINE V interpolated(const float* v, std::size_t next_row, V fx, float fy) {
  const D d;
  const V low = mix(hn::LoadU(d, v), hn::LoadU(d, v + kLanes), fx);
  if (next_row == 0) return low;
  v += next_row;
  return mix(low, mix(hn::LoadU(d, v), hn::LoadU(d, v + kLanes), fx), hn::Set(d, fy));
}

HWY_INLINE float interpolated(const float* v, std::size_t next_row, float fx, float fy) {
  const float low = v[0] + fx * (v[1] - v[0]);
  if (next_row == 0) return low;
  v += next_row;
  return low + fy * (v[0] + fx * (v[1] - v[0]) - low);
}

// Row times `values`.
HWY_INLINE float row_times(const LaneRows& rows, const Lookups::Place* found, const float* slopes,
                           std::size_t channel, const float* values) {
  const D d;
  V sum = hn::Zero(d);
  float rest = 0;
  for (const LaneProduct::Group& group : rows.groups) {
    const auto [node, fx, fy] = found[group.place];
    const float* first = values + group.base + channel * group.channel_stride;
    const float* slope = slopes + group.slot;
    if (group.alone) {
      rest += *slope * interpolated(first + node, group.next_row, fx, fy);
    } else {
      for (std::size_t l = 0; l < kLanes; l += hn::Lanes(d))
        sum = hn::MulAdd(hn::LoadU(d, slope + l),
                         interpolated(first + node * kLanes + l, group.next_row, hn::Set(d, fx), fy), sum);
    }
  }
  return rest + hn::GetLane(hn::SumOfLanes(d, sum));
}

// Adds `amount` times the row to `values`.
HWY_INLINE void add_row(const LaneRows& rows, const Lookups::Place* found, const float* slopes,
                        std::size_t channel, float amount, float* values) {
  const D d;
  for (const LaneProduct::Group& group : rows.groups) {
    const auto [node, fx, fy] = found[group.place];
    float* first = values + group.base + channel * group.channel_stride;
    const float* slope = slopes + group.slot;
    if (group.alone) {
      const float all = amount * *slope, high = fy * all, low = all - high;
      first += node;
      first[0] += low - fx * low;
      first[1] += fx * low;
      if (group.next_row == 0) continue;
      first += group.next_row;
      first[0] += high - fx * high;
      first[1] += fx * high;
    } else {
      first += node * kLanes;
      for (std::size_t l = 0; l < kLanes; l += hn::Lanes(d)) {
        const V all = hn::Mul(hn::Set(d, amount), hn::LoadU(d, slope + l));
        const V high = hn::Mul(hn::Set(d, fy), all), t = hn::Set(d, fx);
        add_split(hn::Sub(all, high), t, first + l);
        if (group.next_row > 0) add_split(high, t, first + group.next_row + l);
      }
    }
  }
}

// Adds J^T J v of the pairs [begin, end) to `sum`.
void multiply(const LaneRows& rows, std::size_t begin, std::size_t end, const float* v, float* sum) {
  for (std::size_t i = begin; i < end; ++i) {
    const Lookups::Place* found = rows.places + i * rows.place_count;
    for (std::size_t c = 0; c < rows.channels; ++c) {
      const float* slopes = rows.slopes + (i * rows.channels + c) * rows.slots;
      add_row(rows, found, slopes, c, row_times(rows, found, slopes, c, v), sum);
    }
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
                         .alone = alone});
      group_family.push_back(family_of[t]);
      slots_ += family.count;
    }
    slot_.push_back(groups_[g].slot + lane_of[t]);
  }
}

// Vectors that are read beyond a family's lanes meet values there that are 0, or sums that none asks for.
std::vector<float> LaneProduct::slopes() const {
  return std::vector<float>(lookups_.places.size() / lookups_.place_count * channels_ * slots_ + kLanes);
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
  const std::size_t count = lookups_.places.size() / lookups_.place_count;
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
