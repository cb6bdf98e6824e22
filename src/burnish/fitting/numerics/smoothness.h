// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <burnish/factors/table.h>

namespace burnish {

/// Linear functionals of a table's nodes whose squares add up to its roughness: row r is the sum of
/// coefficients[k] * x[nodes[k]] for k in [starts[r], starts[r + 1]).
struct SmoothnessRows {
  std::vector<std::uint32_t> starts{0}, nodes;
  std::vector<double> coefficients;

  std::size_t size() const noexcept { return starts.size() - 1; }
};

/// The symmetries of a table where its angles begin and end; see ModelSpec::TableSpec.
struct TableEdges {
  bool even_y = false, pole_x = false, circle_z = false;
};

/// Returns the discrete form of the integral over the unit interval, square or cube of the squared second
/// derivatives, xx^2 + 2 xy^2 + yy^2 and so on (whose normal operator is the Laplacian squared). `kSlopeShare` times
/// the squared first derivatives is added, which keeps extrapolation into regions without data from running away. The
/// value is independent of the resolution.
/// Lines, and grids where `edges` say so, also add the second derivatives at 0 of the table continued as an even
/// function. Where x = 0 is a pole, differences along it weigh so much that there are none. Where layers close a
/// circle, differences between the first and the last weigh so much that they are small beside any error.
SmoothnessRows smoothness_rows(const TableLayout& layout, TableEdges edges = {});

inline constexpr double kSlopeShare = 0.03;
/// The slope share of volumes. No pair of directions reaches a quarter of their nodes; these lie about where their
/// neighbours do.
inline constexpr double kVolumeSlopeShare = 100;

}  // namespace burnish
