// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <burnish/fitting/refinement/lobe_lanes.h>

namespace burnish {

/// Rows of a sparse matrix J over the values of families of tables: each row has in every piece the slopes of
/// a family's lanes at two nodes that are neighbours along x.
struct LaneRows {
  struct Family {
    std::vector<std::size_t> lanes;      ///< of the LobeLanes' family
    std::vector<std::uint32_t> unknown;  ///< of [copy][node][lane]
    std::size_t copy_nodes = 0;          ///< 0: one copy for all channels
    bool in_order = false;               ///< lanes are 0, 1, ...

    std::size_t nodes() const noexcept { return unknown.size() / lanes.size(); }
    /// A vector's, as two neighbours must not share one.
    std::size_t width() const noexcept { return std::bit_ceil(lanes.size()); }
  };
  struct Piece {
    std::size_t family, slot;
    bool second_row, second_layer;  ///< of a cell
    std::size_t start;              ///< its first value
  };
  std::vector<Family> families;
  std::vector<Piece> pieces;
  std::size_t rows = 0;
  std::vector<std::uint32_t> node;  ///< [piece][row], the first of the two
  AlignedVector<float> value;       ///< [piece][row][neighbour][width]
  AlignedVector<double> room;       ///< of scaled_gram

  /// Makes room for rows over the unknowns [first, last) of whole tables.
  void layout(const LobeLanes& model, std::size_t first, std::size_t last, std::size_t row_count);
  /// Row r is `root` times that of a pair, whose block is as LobeLanes::differentiate leaves it.
  void set(const LobeLanes& model, std::size_t pair, std::size_t channel, std::size_t r,
           const LobeLanes::Block& at, float root);
};

/// Lower triangle of D J^T J D, D being the diagonal matrix of `scale`, a number an unknown; what stands
/// above it is meaningless. In double precision, the same for any number of threads.
void scaled_gram(LaneRows& j, const Eigen::VectorXd& scale, Eigen::MatrixXd& gram);

}  // namespace burnish
