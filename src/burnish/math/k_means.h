// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace burnish {

/// Points of so many coordinates, one after the other.
struct Points {
  std::size_t size = 0, coordinates = 0;
  std::vector<double> values;

  std::span<const double> operator[](std::size_t i) const noexcept {
    return std::span(values).subspan(i * coordinates, coordinates);
  }
  std::span<double> operator[](std::size_t i) noexcept {
    return std::span(values).subspan(i * coordinates, coordinates);
  }
};

/// Squared, of points of as many coordinates.
double squared_distance(std::span<const double> a, std::span<const double> b) noexcept;

struct Groups {
  Points centres;
  std::vector<std::size_t> of;     ///< of each point its group
  std::vector<std::size_t> sizes;  ///< of each group, at the last step
};

/// Ten steps of k-means [Lloyd1982] from centres far from each other, the first point's first. Groups may be empty.
/// Deterministic. Precondition: there is a point.
Groups grouped(const Points& points, std::size_t count);

}  // namespace burnish
