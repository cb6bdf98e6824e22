// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/fitting/refinement/lobe_lanes.h>
#include <burnish/math/parallel.h>

#define HWY_TARGET_INCLUDE "burnish/fitting/refinement/lobe_lanes.cpp"
#include <burnish/math/highway-inl.h>

#include <burnish/fitting/refinement/lobe_lanes-inl.h>

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(evaluate);
HWY_EXPORT(differentiate);
HWY_EXPORT(add_transposed);
HWY_EXPORT(add_squares);
HWY_EXPORT(multiply);

constexpr float kMinTotal = 1e-30f;  // whose reciprocal is finite

void prefetch(const void* data, std::size_t bytes) noexcept {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < bytes; at += kLine) hwy::Prefetch(static_cast<const std::byte*>(data) + at);
}

}  // namespace

LobeLanes::LobeLanes(std::span<const NumberedTable> tables, const Lookups& lookups, std::size_t channels)
    : lookups_(lookups),
      channels_(channels),
      parts_(chunk_count(lookups.lobes.size(), kLanes)),
      tables_(tables.begin(), tables.end()) {
  // A slot is what up to kLanes lobes of one part look up at one place, a lane a lobe. A lobe takes the first slot
  // with its place whose lane is free.
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
      lanes[s][j % kLanes] = lookups.lookups[k].table;
    }

  // Slots of the same tables form a family and share its values.
  std::vector<std::size_t> nodes;  // nodes of each family's tables
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
    const int axes = axis_count(layout.shape);
    slot.next_row = axes > 1 ? static_cast<std::size_t>(layout.width) * kLanes : 0;
    slot.next_layer = axes > 2 ? slot.next_row * static_cast<std::size_t>(layout.height) : 0;
  }

  // Links map each unknown to all its places among the lanes.
  for (std::size_t f = 0; f < families_.size(); ++f)
    for (std::size_t l = 0; l < kLanes; ++l) {
      if (families_[f].tables[l] == kNone) continue;
      const NodeNumbers& number = tables[families_[f].tables[l]].number;
      for (std::size_t n = 0; n < nodes[f]; ++n)
        for (std::size_t c = 0; c < channels; ++c)
          links_.push_back(
              {static_cast<std::uint32_t>(number(n, c)),
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

  // The mean of each table's logarithms is divided out of its values, so that floats hold them well.
  std::vector<double> means(tables_.size() * channels_);
  for (std::size_t t = 0; t < tables_.size(); ++t) {
    const auto& [number, layout] = tables_[t];
    const auto nodes = static_cast<Eigen::Index>(layout.node_count());
    for (std::size_t c = 0; c < channels_; ++c) {
      Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>> logs(
          found.lambda.data() + number(0, c), nodes,
          Eigen::InnerStride<>(static_cast<Eigen::Index>(number.copies)));
      if (c > 0 && number.copies == 1) {
        means[t * channels_ + c] = means[t * channels_];
        continue;
      }
      const double mean = means[t * channels_ + c] = logs.mean();
      logs.array() -= mean;
    }
  }
  found.lambda = found.lambda.array().exp();
  found.lambdas = spread(found.lambda, 1);

  // The means come back as scales: lobe j's is exp of the sum of its tables' means.
  for (std::size_t c = 0; c < channels_; ++c)
    for (std::size_t j = 0; j < lookups_.lobes.size(); ++j) {
      double sum = 0;
      for (const std::size_t k : lookups_.lobes[j]) sum += means[lookups_.lookups[k].table * channels_ + c];
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
  // Products start as the lobes' scales, times the weights of lobes where the pairs have them.
  for (std::size_t p = 0; p < parts_; ++p) {
    const float* scales = values.scales.data() + (channel * parts_ + p) * kLanes;
    for (std::size_t i = 0; i < kBlock; ++i)
      std::copy_n(scales, kLanes, at.product.data() + p * kBlockLanes + i * kLanes);
  }
  if (!lookups_.lobe_weights.empty()) {
    const std::size_t lobes = lookups_.lobes.size();
    const float* weight = lookups_.lobe_weights.data() + block * kBlock * lobes;
    for (std::size_t i = 0; i < kBlock; ++i)
      for (std::size_t j = 0; j < lobes; ++j)
        at.product[j / kLanes * kBlockLanes + i * kLanes + j % kLanes] *= *weight++;
  }
  HWY_DYNAMIC_DISPATCH(evaluate)
  (slots_, parts_, places(block), values.lambdas.data() + channel * channel_size_, at.factor.data(),
   at.product.data(), at.total.data());
  for (float& total : at.total) total = std::max(total, kMinTotal);
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
  // Each group of blocks sums J^T (J v) of its pairs.
  const AlignedVector<float> lanes = spread(v, 0);
  const std::size_t group_size = (blocks() + kMaxGroups - 1) / kMaxGroups;
  std::vector<AlignedVector<float>> partial(chunk_count(blocks(), group_size));
  for_each_chunk(blocks(), group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    partial[group].resize(lanes.size());
    AlignedVector<float> slopes(slots_.size() * kBlockLanes);
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t c = 0; c < channels_; ++c) {
        if (b + 1 < end) {  // The memory is many short streams, which the processor does not foresee.
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

  // Groups are summed in their order, which gives the same bits for any number of threads.
  AlignedVector<float>& sum = partial.front();
  for (std::size_t g = 1; g < partial.size(); ++g)
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += partial[g][k];
  Eigen::VectorXd product = Eigen::VectorXd::Zero(v.size());
  gather(sum, product);
  return product;
}

}  // namespace burnish
#endif
