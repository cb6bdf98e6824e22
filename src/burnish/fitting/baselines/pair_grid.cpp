// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/baselines/separable_brdf.h>
#include <burnish/error.h>
#include <burnish/fitting/baselines/pair_grid.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {

namespace {

/// Reduces theta_h and then theta_d until both cosines reach kDrawnCosine. Returns whether they did before.
bool pull_above_horizon(PairFrame& frame) {
  const auto [wi, wo] = frame.directions();
  if (std::min(wi.z, wo.z) >= kDrawnCosine) return true;
  // just inside, against rounding
  if (const double most = std::acos(kDrawnCosine) * (1 - 1e-9); theta_of(frame.h) > most) {
    frame.h = spherical_direction(most, phi_of(frame.h));
    frame.across = normalize(frame.across - dot(frame.across, frame.h) * frame.h);
  }
  // the lower direction's z is length cos(theta_d + tilt)
  const double aside = std::abs(frame.across.z), tilt = std::atan2(aside, frame.h.z),
               length = std::hypot(aside, frame.h.z);
  const double highest = std::acos(std::min(kDrawnCosine / length, 1.0)) - tilt;
  frame.theta_d = std::clamp(highest * (1 - 1e-9), 0.0, frame.theta_d);
  return false;
}

/// Spreads values to unknown nodes from those next to them along any axis, ring by ring.
void spread(PairGrid& grid, std::vector<std::uint8_t>& known) {
  std::vector<std::size_t> sides;
  for (const auto* axes : {&grid.row_axes, &grid.column_axes})
    for (const NodeAxis& axis : *axes) sides.push_back(static_cast<std::size_t>(axis.count));
  for (;;) {
    std::vector<std::size_t> reached;
    const std::vector<std::uint8_t> before = known;
    for (std::size_t node = 0; node < known.size(); ++node) {
      if (before[node]) continue;
      std::size_t stride = 1, neighbours = 0;
      for (std::size_t axis = sides.size(); axis-- > 0; stride *= sides[axis]) {
        const std::size_t at = node / stride % sides[axis];
        for (const bool up : {false, true}) {
          if (up ? at + 1 == sides[axis] : at == 0) continue;
          const std::size_t other = up ? node + stride : node - stride;
          if (!before[other]) continue;
          ++neighbours;
          for (std::size_t c = 0; c < grid.channels; ++c)
            grid.values[node * grid.channels + c] += grid.values[other * grid.channels + c];
        }
      }
      if (neighbours == 0) continue;
      known[node] = 1;
      reached.push_back(node);
      for (std::size_t c = 0; c < grid.channels; ++c)
        grid.values[node * grid.channels + c] /= static_cast<double>(neighbours);
    }
    if (reached.empty()) return;
  }
}

std::size_t node_count(std::span<const NodeAxis> axes) {
  std::size_t count = 1;
  for (const NodeAxis& axis : axes) count *= static_cast<std::size_t>(axis.count);
  return count;
}

}  // namespace

PairGrid sample_pair_grid(BrdfRef source, std::span<const NodeAxis> rows, std::span<const NodeAxis> columns) {
  PairGrid grid{.row_axes = {rows.begin(), rows.end()},
                .column_axes = {columns.begin(), columns.end()},
                .rows = node_count(rows),
                .columns = node_count(columns),
                .channels = source.channels(),
                .values = {},
                .measured = {}};
  std::vector<NodeAxis> axes(rows.begin(), rows.end());
  axes.insert(axes.end(), columns.begin(), columns.end());
  std::vector<PairCoordinate> coordinates;
  for (const NodeAxis& axis : axes) coordinates.push_back(axis.coordinate);
  const bool folded =
      std::find(coordinates.begin(), coordinates.end(), PairCoordinate::phi_d) != coordinates.end();

  // the source at every node's directions, pulled above the horizon
  const std::size_t nodes = grid.rows * grid.columns;
  grid.values.resize(nodes * grid.channels);
  grid.measured.resize(nodes);
  std::vector<std::uint8_t> known(nodes);
  constexpr std::size_t kChunk = 512;
  for_each_chunk(nodes, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<double> place(axes.size()), f(grid.channels), mirrored(grid.channels);
    for (std::size_t node = begin; node < end; ++node) {
      std::size_t rest = node;
      for (std::size_t axis = axes.size(); axis-- > 0;) {
        const auto side = static_cast<std::size_t>(axes[axis].count);
        place[axis] = axes[axis].node(static_cast<int>(rest % side));
        rest /= side;
      }
      PairFrame frame = pair_at(coordinates, place);
      grid.measured[node] = pull_above_horizon(frame);
      const auto [wi, wo] = frame.directions();
      known[node] = source.eval(wi, wo, f);
      if (folded && known[node] && source.eval({wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}, mirrored))
        for (std::size_t c = 0; c < f.size(); ++c) f[c] = 0.5 * (f[c] + mirrored[c]);
      if (!known[node]) continue;
      for (std::size_t c = 0; c < f.size(); ++c)
        grid.values[node * grid.channels + c] = std::max(f[c], 0.0) * separable_divisor(wi, wo);
    }
  });

  // where it is unknown, what the neighbours know
  for (std::size_t node = 0; node < nodes; ++node) grid.measured[node] = grid.measured[node] && known[node];
  if (std::find(known.begin(), known.end(), 1) == known.end())
    throw Error("decomposition: expected a source with known values, found none");
  spread(grid, known);
  return grid;
}

}  // namespace burnish
