// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <Eigen/Core>

#include <burnish/fitting/refinement/lobe_lanes.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// The albedos of some channels of a model beside those that they should have: a few residuals, each a sum over
/// many pairs and so linear in the values of f^.
class AlbedoTerm {
 public:
  /// Makes the residuals of the channels [first_channel, first_channel + channels). `set` must outlive it; an empty
  /// set gives no residuals.
  AlbedoTerm(const ModelSpec& spec, std::span<const LobeLanes::NumberedTable> tables, const AlbedoSet& set,
             std::size_t all_channels, std::size_t first_channel, std::size_t channels);

  std::size_t size() const noexcept { return set_.directions * channels_; }
  /// Returns (albedo - target) / scale, [direction][channel], given the logarithms of the unknowns.
  Eigen::VectorXd residuals(const Eigen::VectorXd& x) const;

  struct Rows {
    Eigen::VectorXd residuals;
    Eigen::MatrixXd slopes;  ///< a column a residual: its derivatives by x
  };
  Rows rows(const Eigen::VectorXd& x) const;

 private:
  // Calls visit(channel, block, weights over the scale) for each block of a direction's points.
  template <class Visit>
  void for_each_block(std::size_t direction, Visit visit) const;
  double target(std::size_t direction, std::size_t channel) const noexcept;

  const AlbedoSet& set_;
  std::size_t all_channels_, first_channel_, channels_;
  // The lanes refer to the lookups, so both stay at one place in memory.
  std::unique_ptr<const Lookups> lookups_;
  std::unique_ptr<const LobeLanes> lanes_;
};

}  // namespace burnish
