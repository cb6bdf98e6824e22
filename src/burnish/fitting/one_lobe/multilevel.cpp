// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <type_traits>

#include <burnish/fitting/one_lobe/multilevel.h>

namespace burnish {

namespace {

// Returns the nodes of an axis on the next coarser level.
int halved(int n) {
  return n > 2 ? (n + 1) / 2 : 1;
}

/// Calls body(step); the usual steps are constants to the compiler.
template <class Body>
void with_constant(std::size_t step, const Body& body) {
  if (step == 1)
    body(std::integral_constant<std::size_t, 1>());
  else if (step == 4)
    body(std::integral_constant<std::size_t, 4>());
  else
    body(step);
}

}  // namespace

GridTransfer::GridTransfer(const TableLayout& fine, int coarse_width, int coarse_height, int coarse_depth) {
  const auto axis = [](int fine_nodes, int nodes) {
    return Axis{fine_nodes, nodes, fine_nodes > 1 ? (nodes - 1.0) / (fine_nodes - 1.0) : 0};
  };
  x_ = axis(fine.width, coarse_width);
  y_ = axis(fine.height, coarse_height);
  z_ = axis(fine.depth, coarse_depth);
  // The coarse corners of every fine node and their weights are found once.
  for (int node = 0; node < fine_count(); ++node) {
    const Corners at = corners({.node = node});
    for (std::size_t k = 0; k < at.count; ++k)
      if (at.weight[k] != 0) weighed_.push_back({static_cast<std::uint32_t>(at.node[k]), at.weight[k]});
    starts_.push_back(static_cast<std::uint32_t>(weighed_.size()));
  }
}

GridTransfer::Corners GridTransfer::corners(const Lookup& fine) const noexcept {
  // Finds the two coarse nodes along an axis, and their linear weights.
  struct Place {
    std::size_t node[2];
    double weight[2];
  };
  const auto place = [](const Axis& axis, double position) -> Place {
    const double at = position * axis.scale;
    const int low = std::clamp(static_cast<int>(at), 0, std::max(axis.nodes - 2, 0));
    const double above = at - low;
    return {{static_cast<std::size_t>(low), static_cast<std::size_t>(std::min(low + 1, axis.nodes - 1))},
            {1 - above, above}};
  };
  const int row = fine.node / x_.fine_nodes;
  const Place x = place(x_, fine.node % x_.fine_nodes + fine.fx);
  const Place y = place(y_, row % y_.fine_nodes + fine.fy);
  const Place z = place(z_, row / y_.fine_nodes + fine.fz);
  const auto width = static_cast<std::size_t>(x_.nodes), height = static_cast<std::size_t>(y_.nodes);
  Corners at{.count = z_.fine_nodes > 1 ? std::size_t{8} : std::size_t{4}, .node = {}, .weight = {}};
  for (std::size_t k = 0; k < at.count; ++k) {
    const std::size_t i = k & 1, j = k >> 1 & 1, l = k >> 2;
    at.node[k] = (z.node[l] * height + y.node[j]) * width + x.node[i];
    at.weight[k] = y.weight[j] * x.weight[i] * (z_.fine_nodes > 1 ? z.weight[l] : 1);
  }
  return at;
}

void GridTransfer::restrict_to(const double* fine, double* coarse, std::size_t step) const {
  // Restriction is the transpose of interpolation: each fine value is shared out among its coarse corners.
  std::fill_n(coarse, coarse_count() * step, 0.0);
  with_constant(step, [&](auto channels) {
    const double* from = fine;
    for (std::size_t node = 0; node + 1 < starts_.size(); ++node, from += channels)
      for (std::uint32_t k = starts_[node]; k < starts_[node + 1]; ++k)
        for (std::size_t c = 0; c < channels; ++c)
          coarse[weighed_[k].node * channels + c] += weighed_[k].weight * from[c];
  });
}

void GridTransfer::add_interpolated(const double* coarse, double* fine, std::size_t step) const {
  with_constant(step, [&](auto channels) {
    double* to = fine;
    for (std::size_t node = 0; node + 1 < starts_.size(); ++node, to += channels)
      for (std::uint32_t k = starts_[node]; k < starts_[node + 1]; ++k)
        for (std::size_t c = 0; c < channels; ++c)
          to[c] += weighed_[k].weight * coarse[weighed_[k].node * channels + c];
  });
}

std::vector<GridTransfer> coarser_levels(const TableLayout& layout) {
  std::vector<GridTransfer> levels;
  for (int w = layout.width, h = layout.height, d = layout.depth; w > 1 || h > 1 || d > 1;) {
    w = halved(w);
    h = halved(h);
    d = halved(d);
    levels.emplace_back(layout, w, h, d);
  }
  return levels;
}

}  // namespace burnish
