// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <burnish/factors/table.h>

namespace burnish {

/// Linear interpolation between a table's nodes and those of the same table at a lower resolution, the corner
/// nodes in common. Values have `step` channels a node.
class GridTransfer {
 public:
  GridTransfer(const TableLayout& fine, int coarse_width, int coarse_height, int coarse_depth = 1);

  std::size_t coarse_count() const noexcept {
    return static_cast<std::size_t>(x_.nodes) * static_cast<std::size_t>(y_.nodes) *
           static_cast<std::size_t>(z_.nodes);
  }
  int coarse_width() const noexcept { return x_.nodes; }
  int coarse_height() const noexcept { return y_.nodes; }
  int coarse_depth() const noexcept { return z_.nodes; }
  /// The coarse nodes and weights of a lookup in the fine table: four, of a volume eight, some of weight 0.
  struct Corners {
    std::size_t count;
    std::size_t node[8];
    double weight[8];
  };
  Corners corners(const Lookup& fine) const noexcept;

  /// coarse = transpose of interpolation of fine.
  void restrict_to(const double* fine, double* coarse, std::size_t step) const;
  /// fine += interpolation of coarse.
  void add_interpolated(const double* coarse, double* fine, std::size_t step) const;

 private:
  struct Axis {
    int fine_nodes = 1, nodes = 1;
    double scale = 0;
  };
  struct Weighed {
    std::uint32_t node;
    double weight;
  };
  int fine_count() const noexcept { return x_.fine_nodes * y_.fine_nodes * z_.fine_nodes; }

  Axis x_, y_, z_;
  // of fine node i those from starts_[i] to starts_[i + 1], without weights of 0
  std::vector<Weighed> weighed_;
  std::vector<std::uint32_t> starts_{0};
};

/// The resolutions below a table's own: sides halved down to 2, then 1; coarsest last.
std::vector<GridTransfer> coarser_levels(const TableLayout& layout);

}  // namespace burnish
