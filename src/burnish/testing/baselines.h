// SPDX-License-Identifier: Apache-2.0
#pragma once

// Small random baselines.

#include <vector>

#include <burnish/baselines/dgf_brdf.h>
#include <burnish/baselines/separable_brdf.h>
#include <burnish/math/random.h>

namespace burnish::fixtures {

/// Returns a table of values in [low, 1), rounded to half floats.
inline NodeTable random_table(std::vector<NodeAxis> axes, std::size_t channels, int terms, double low,
                              std::uint64_t seed) {
  NodeTable table{std::move(axes), channels, terms, {}};
  Pcg32 random(seed);
  table.values.resize(table.node_count() * static_cast<std::size_t>(channels * terms));
  for (float& v : table.values) v = round_to_half(low + (1 - low) * random.uniform());
  return table;
}

inline SeparableBrdf random_separable(int terms = 2, double low = -0.3) {
  using enum PairCoordinate;
  return SeparableBrdf(random_table({{theta_h, 7}}, 3, terms, low, 1),
                       random_table({{theta_d, 5}, {phi_d, 3}}, 1, terms, low, 2), {1.5f, 2.5f, 0.1f});
}

inline SeparableBrdf random_anisotropic() {
  using enum PairCoordinate;
  return SeparableBrdf(random_table({{half_x, 5}, {half_y, 4}, {theta_d, 3}}, 1, 2, -0.2, 3),
                       random_table({{turn_d, 4}}, 3, 2, -0.2, 4), {1, 2, 3});
}

inline DgfBrdf random_dgf() {
  using enum PairCoordinate;
  return DgfBrdf({0.1f, 0.2f, 0.3f}, {0.5f, 0.25f, 1.0f}, random_table({{theta_h, 6}}, 3, 1, 0, 5),
                 random_table({{theta_d, 5}}, 1, 1, 0, 6), random_table({{theta_d, 4}}, 3, 1, 0, 7));
}

}  // namespace burnish::fixtures
