// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/math/point2.h>

namespace burnish {

/// Slices of a conditioned table and their weights (which sum to 1): the linear or bilinear interpolation
/// between the parameters of the slices.
struct SliceMix {
  std::array<std::uint32_t, 4> slice{};
  std::array<double, 4> weight{};
  int count = 0;
};

/// Maps the unit square to itself so that uniform points become points of a given density, conditioned on
/// parameters. The density is bilinear between the nodes of a grid that spans the square; rows are chosen by
/// their marginal distribution, then the place within the row. Parameters interpolate the densities linearly.
/// Source: [Dupuy 2018, sec. 4].
class ConditionalWarp2 {
 public:
  ConditionalWarp2() = default;
  /// `density` is [slices][height][width], at any scale of its own in each slice.
  /// Throws Error unless width and height are at least 2, the size fits, and every slice is finite, >= 0 and
  /// not zero throughout.
  ConditionalWarp2(int width, int height, std::span<const float> density);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }

  /// Density of `p` in [0, 1]^2 with respect to area; it integrates to 1.
  double pdf(Point2 p, const SliceMix& mix) const noexcept;
  /// The point that becomes `p`, in [0, 1]^2: the inverse of warp, within 1e-5 where the density is positive.
  Point2 invert(Point2 p, const SliceMix& mix) const noexcept;
  /// The point of the density that the uniform point `u` in [0, 1]^2 becomes.
  Point2 warp(Point2 u, const SliceMix& mix) const noexcept;

 private:
  struct Node {
    double density;  // integral 1 over cells of unit size
    double before;   // integral of the row from its start to this node
  };
  struct Row {
    double total;   // integral of the whole row
    double before;  // integral of the rows' totals from the first to this one
  };
  struct Patch;
  Patch patch(int column, int row, const SliceMix& mix) const noexcept;

  int width_ = 0, height_ = 0;
  std::vector<Node> nodes_;
  std::vector<Row> rows_;
};

}  // namespace burnish
