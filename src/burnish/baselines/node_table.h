// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <burnish/baselines/pair_coordinates.h>

namespace burnish {

/// A table's nodes along one coordinate: at i / (count - 1), or at i / count where it is periodic.
struct NodeAxis {
  PairCoordinate coordinate = PairCoordinate::theta_h;
  int count = 0;  ///< in [2, kMaxSide] of factors/table.h

  double node(int i) const noexcept {
    return static_cast<double>(i) / (is_periodic(coordinate) ? count : count - 1);
  }

  friend bool operator==(const NodeAxis&, const NodeAxis&) = default;
};

/// Half floats over a grid of pair coordinates, linear between nodes; the last axis varies fastest.
struct NodeTable {
  static constexpr std::size_t kMaxAxes = 3;

  std::vector<NodeAxis> axes;  ///< 1 to kMaxAxes
  std::size_t channels = 1;    ///< 1 (shared by the BRDF's channels) or the BRDF's channel count
  int terms = 1;
  std::vector<float> values;  ///< [node][channel][term], each exactly a half float

  std::size_t node_count() const noexcept;

  friend bool operator==(const NodeTable&, const NodeTable&) = default;
};

/// The nodes around a place and their weights, which sum to 1.
struct NodeCorners {
  std::array<std::size_t, std::size_t{1} << NodeTable::kMaxAxes> node;
  std::array<double, std::size_t{1} << NodeTable::kMaxAxes> weight;
  std::size_t count = 0;
};

NodeCorners corners(std::span<const NodeAxis> axes, const PairPlace& place) noexcept;

/// Value of one channel and term. Precondition: channel < channels, term < terms.
double node_value(const NodeTable& table, const NodeCorners& at, std::size_t channel,
                  std::size_t term) noexcept;

/// Throws Error, naming the table, unless the axes, channels and values are as documented.
void check_node_table(const NodeTable& table, std::size_t brdf_channels, const std::string& name);

/// The nearest half float; beyond the largest of them, the largest.
float round_to_half(double value) noexcept;

}  // namespace burnish
