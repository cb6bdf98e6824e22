// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <burnish/fitting/numerics/band_matrix.h>
#include <burnish/fitting/refinement/lobe_lanes.h>
#include <burnish/fitting/refinement/lookups.h>
#include <burnish/parameterization/projection.h>

namespace burnish {

/// Most of a Gauss-Newton matrix over a model's nodes, solved directly: a good preconditioner. In order of one
/// coordinate that every volume has, pairs couple only nodes near each other: volumes, and whatever else is
/// looked up along that coordinate, make a band. The other tables make a block of their own, a diagonal where
/// they are large; what couples the two is left out.
class NodeBand {
 public:
  NodeBand(std::span<const LobeLanes::NumberedTable> tables, const Lookups& lookups, std::size_t channels);

  void set_zero();
  /// A row's derivative by the logarithm of a node.
  struct Term {
    std::uint32_t unknown;
    double slope;
  };
  /// Adds weight times the products of a row's terms; fastest where rows of the same nodes follow each other.
  void add_row(std::span<const Term> row, double weight);
  /// Adds a row whose products may lie outside the band. Each of those is put on the diagonal, which keeps the matrix
  /// positive.
  void add_wide_row(std::span<const Term> row, double weight);
  /// Adds `extra` to the diagonal and factorizes; false where rounding made the matrix indefinite.
  bool factorize(const Eigen::VectorXd& extra);
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  /// Returns true if an unknown stands in the band; banded() lists these in the band's order.
  bool is_banded(std::uint32_t unknown) const noexcept { return (place_[unknown] & kInRest) == 0; }
  std::span<const std::uint32_t> banded() const noexcept { return banded_; }
  /// The factorized band.
  const BandMatrix& band() const noexcept { return band_; }

 private:
  static constexpr std::uint32_t kInRest = 1u << 31;  // of a place

  void add(std::uint32_t a, std::uint32_t b, double value);
  void add_sums();
  // Puts tables with an axis of the key projection in its order, and all others into the rest.
  void order(std::span<const LobeLanes::NumberedTable> tables, const Lookups& lookups,
             const std::optional<Projection>& key);
  std::size_t band_width(std::span<const LobeLanes::NumberedTable> tables, const Lookups& lookups,
                         std::size_t channels) const;

  std::vector<std::uint32_t> place_;  ///< of an unknown, in the band or in the rest
  std::vector<std::uint32_t> banded_;
  std::size_t rest_count_ = 0;
  // Nodes that consecutive rows share, and the sums of their products.
  std::vector<std::uint32_t> nodes_;
  std::vector<double> slopes_, sums_;
  BandMatrix band_;
  Eigen::MatrixXd rest_;  ///< its lower triangle; one column, the diagonal, where it is large
};

}  // namespace burnish
