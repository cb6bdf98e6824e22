// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <burnish/baselines/node_table.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A BRDF resampled for decomposition: f sqrt(cos θ_i cos θ_o), what SeparableBrdf divides, at every pair of
/// a row node and a column node.
struct PairGrid {
  std::vector<NodeAxis> row_axes, column_axes;
  std::size_t rows = 0, columns = 0, channels = 0;
  std::vector<double> values;          ///< [row][column][channel], >= 0
  std::vector<std::uint8_t> measured;  ///< [row][column], 0 where filled in
};

/// Resamples a source. Coordinates that fold phi_d take the mean of both mirror images. Where a node lies
/// closer to the horizon than kDrawnCosine, theta_h and then theta_d are reduced until it does not; where the
/// source knows nothing, the value is spread from nodes that are known. Throws Error if the source knows none
/// of the nodes. Precondition: each axis has 2 nodes or more.
PairGrid sample_pair_grid(BrdfRef source, std::span<const NodeAxis> rows, std::span<const NodeAxis> columns);

}  // namespace burnish
