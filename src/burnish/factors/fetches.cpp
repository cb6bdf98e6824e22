// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <burnish/factors/fetches.h>

namespace burnish {

namespace {

// Returns the part of a use that a lookup depends on: no more projections than its table has.
FactorUse read_of(FactorUse use, TableShape shape) {
  const int count = projection_count(shape);
  if (count < 2) use.projection_y = {};
  if (count < 3) use.projection_z = {};
  return use;
}

void add_read(const FactorUse& read, std::vector<FactorUse>& reads) {
  if (std::ranges::find(reads, read) == reads.end()) reads.push_back(read);
}

}  // namespace

std::size_t fetch_count(const FactoredBrdf& brdf) {
  std::vector<FactorUse> reads;
  for (const Lobe& lobe : brdf.lobes())
    for (const FactorUse& use : lobe.factors) add_read(read_of(use, brdf.table_of(use).layout.shape), reads);
  return reads.size();
}

std::size_t fetch_count(const ModelSpec& spec) {
  std::vector<FactorUse> reads;
  for (const std::vector<FactorUse>& lobe : spec.lobes)
    for (const FactorUse& use : lobe) add_read(read_of(use, spec.tables[use.table].layout.shape), reads);
  return reads.size();
}

std::size_t texture_count(const FactoredBrdf& brdf) noexcept {
  const auto volumes = std::ranges::count_if(
      brdf.tables(), [](const Table& table) { return table.layout.shape == TableShape::volume; });
  return static_cast<std::size_t>(volumes > 0) + (static_cast<std::size_t>(volumes) < brdf.tables().size());
}

}  // namespace burnish
