// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cassert>

#include <burnish/factors/table_gradient.h>

namespace burnish {

namespace {

// The nodes that a lookup mixes, and their weights, whose sum is 1.
struct Corners {
  std::array<std::size_t, 8> node;
  std::array<double, 8> weight;
  std::size_t count = 0;
};

Corners corners_of(const TableLayout& layout, const Lookup& at) noexcept {
  const auto width = static_cast<std::size_t>(layout.width);
  const std::array<std::size_t, 3> step{1, width, width * static_cast<std::size_t>(layout.height)};
  const std::array<double, 3> fraction{at.fx, at.fy, at.fz};
  Corners corners;
  corners.node[0] = static_cast<std::size_t>(at.node);
  corners.weight[0] = 1;
  corners.count = 1;
  // Each axis splits every corner into the one below and the one above.
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(axis_count(layout.shape)); ++axis) {
    for (std::size_t k = 0; k < corners.count; ++k) {
      corners.node[corners.count + k] = corners.node[k] + step[axis];
      corners.weight[corners.count + k] = corners.weight[k] * fraction[axis];
      corners.weight[k] *= 1 - fraction[axis];
    }
    corners.count *= 2;
  }
  return corners;
}

double mixed(const Table& table, const Corners& corners, std::size_t channel) noexcept {
  double sum = 0;
  for (std::size_t k = 0; k < corners.count; ++k)
    sum += corners.weight[k] * table.values[corners.node[k] * table.channels + channel];
  return sum;
}

}  // namespace

std::vector<std::vector<double>> zero_table_gradient(const FactoredBrdf& brdf) {
  std::vector<std::vector<double>> gradient;
  for (const Table& table : brdf.tables()) gradient.emplace_back(table.values.size(), 0.0);
  return gradient;
}

void add_table_gradient(const FactoredBrdf& brdf, Vec3 wi, Vec3 wo, std::span<const double> weight,
                        std::span<std::vector<double>> gradient) noexcept {
  const std::size_t channels = brdf.channels();
  assert(weight.size() == channels && gradient.size() == brdf.tables().size());
  if (wi.z <= 0 || wo.z <= 0) return;
  std::array<double, SymmetrizedBrdf::kMaxChannels> product;
  for (const Lobe& lobe : brdf.lobes()) {
    for (std::size_t c = 0; c < channels; ++c) product[c] = weight[c] * lobe.scale[c];
    for (const FactorUse& use : lobe.factors) {
      const Table& table = brdf.table_of(use);
      const Corners corners = corners_of(table.layout, locate(table.layout, use, wi, wo));
      for (std::size_t c = 0; c < channels; ++c)
        product[c] *= mixed(table, corners, table.channels == 1 ? 0 : c);
    }
    // A value changes a lobe by its weight in a lookup times the product of the other lookups. Lookups are positive,
    // so that product is the whole one divided by this lookup. A table that is looked up twice gets both terms.
    for (const FactorUse& use : lobe.factors) {
      const Table& table = brdf.table_of(use);
      const Corners corners = corners_of(table.layout, locate(table.layout, use, wi, wo));
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t of_table = table.channels == 1 ? 0 : c;
        const double others = product[c] / mixed(table, corners, of_table);
        for (std::size_t k = 0; k < corners.count; ++k)
          gradient[use.table][corners.node[k] * table.channels + of_table] += corners.weight[k] * others;
      }
    }
  }
}

}  // namespace burnish
