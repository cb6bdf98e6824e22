// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <numeric>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/refinement/lookups.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

const TableLayout& layout_of(const ModelSpec& spec, const FactorUse& use) {
  return spec.tables[use.table].layout;
}

/// Locates every distinct lookup of every pair, block by block. The last block is filled up with the last pair.
std::vector<Lookups::Place> places_of(const ModelSpec& spec, const std::vector<FactorUse>& distinct,
                                      const TrainingSet& set) {
  const std::size_t blocks = chunk_count(set.size(), Lookups::kBlock);
  std::vector<Lookups::Place> places(blocks * Lookups::kBlock * distinct.size());
  for_each_chunk(blocks, Lookups::kBlocksATask, [&](std::size_t, std::size_t begin, std::size_t end) {
    auto place = places.begin() + static_cast<std::ptrdiff_t>(begin * Lookups::kBlock * distinct.size());
    for (std::size_t block = begin; block < end; ++block)
      for (const FactorUse& use : distinct)
        for (std::size_t i = block * Lookups::kBlock; i < (block + 1) * Lookups::kBlock; ++i) {
          const auto& [wi, wo] = set.pairs[std::min(i, set.size() - 1)];
          // Places are located in doubles, as evaluation defines them, and kept as floats.
          const Lookup at = locate(layout_of(spec, use), use, wi, wo);
          *place++ = {static_cast<std::uint32_t>(at.node), static_cast<float>(at.fx),
                      static_cast<float>(at.fy), static_cast<float>(at.fz)};
        }
  });
  return places;
}

/// Returns the set's weights in whole blocks: the last pair's weights fill up the last block.
std::vector<float> lobe_weights_of(const TrainingSet& set, std::size_t lobes) {
  if (set.lobe_weights.empty()) return {};
  if (set.lobe_weights.size() != lobes * set.size())
    throw Error(fmt::format("fit: expected {} weights of lobes, found {}", lobes * set.size(),
                            set.lobe_weights.size()));
  std::vector<float> weights = set.lobe_weights;
  while (weights.size() < chunk_count(set.size(), Lookups::kBlock) * Lookups::kBlock * lobes)
    weights.push_back(weights[weights.size() - lobes]);
  return weights;
}

}  // namespace

Lookups lookups_of(const ModelSpec& spec, const TrainingSet& set) {
  Lookups found;

  // Equal lookups of several lobes are kept once.
  for (const auto& lobe : spec.lobes) {
    std::vector<std::size_t>& of_lobe = found.lobes.emplace_back();
    for (const FactorUse& use : lobe) {
      of_lobe.push_back(
          static_cast<std::size_t>(std::ranges::find(found.lookups, use) - found.lookups.begin()));
      if (of_lobe.back() == found.lookups.size()) found.lookups.push_back(use);
    }
  }

  // Lookups that always fall on the same nodes share one place.
  std::vector<FactorUse> distinct;
  for (const FactorUse& use : found.lookups) {
    const auto known = std::ranges::find_if(distinct, [&](const FactorUse& other) {
      return located_alike(layout_of(spec, use), use, layout_of(spec, other), other);
    });
    found.place_of.push_back(static_cast<std::size_t>(known - distinct.begin()));
    if (known == distinct.end()) distinct.push_back(use);
  }
  found.place_count = distinct.size();

  found.pairs = set.size();
  found.places = places_of(spec, distinct, set);
  found.lobe_weights = lobe_weights_of(set, spec.lobes.size());
  return found;
}

TrainingSet ordered_by_cells(const TrainingSet& set, const ModelSpec& spec) {
  const Lookups found = lookups_of(spec, set);

  // Pairs are sorted by the cell of the largest table, then by that of the second largest.
  std::vector<std::size_t> nodes(found.place_count);
  for (std::size_t k = 0; k < found.lookups.size(); ++k)
    nodes[found.place_of[k]] = spec.tables[found.lookups[k].table].layout.node_count();
  std::vector<std::size_t> places(found.place_count);
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::ranges::stable_sort(places, std::greater{}, [&](std::size_t p) { return nodes[p]; });

  struct Placed {
    std::uint64_t cells;
    std::size_t pair;
  };
  std::vector<Placed> placed(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const auto node = [&](std::size_t k) -> std::uint64_t {
      constexpr std::size_t kBlock = Lookups::kBlock;
      const std::size_t block = i / kBlock * found.place_count;
      return k < places.size() ? found.places[(block + places[k]) * kBlock + i % kBlock].node : 0;
    };
    placed[i] = {node(0) << 32 | node(1), i};
  }
  const auto others = placed.begin() + static_cast<std::ptrdiff_t>(set.picture_count);
  std::stable_sort(placed.begin(), others,
                   [](const Placed& a, const Placed& b) { return a.cells < b.cells; });
  std::stable_sort(others, placed.end(), [](const Placed& a, const Placed& b) { return a.cells < b.cells; });
  std::vector<std::size_t> order;
  for (const Placed& each : placed) order.push_back(each.pair);
  return taken(set, order);
}

}  // namespace burnish
