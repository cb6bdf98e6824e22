// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/math/kd_tree.h>
#include <burnish/reflectance/log_covariance.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// Predicts each sample from its nearest others, by kriging ln(f + 1e-3) under the default LogCovariance. Unlike
/// KrigedNodes it uses few neighbours and does not search for the likeliest covariance. It answers questions about
/// samples.
/// Source: [Rasmussen 2006, eq. 2.25 and 2.26].
class LeaveOneOut {
 public:
  static constexpr std::size_t kPredicting = 12;  ///< samples that one is predicted from

  /// Prepares the samples whose cosines are both above KrigedNodes::kLeastCosine, taken as isotropic or not.
  LeaveOneOut(const Samples& samples, bool isotropic);

  /// Returns the number of samples. They have an order of their own, in which near ones are near.
  std::size_t size() const noexcept { return number_.size(); }
  /// Returns the index that a sample had.
  std::size_t number(std::size_t i) const noexcept { return number_[i]; }

  /// Returns at most `count` nearest others among those that are not left out, nearest first. left_out: [sample], or
  /// empty.
  std::vector<KdTree::Neighbour> nearest(std::size_t i, std::size_t count,
                                         std::span<const std::uint8_t> left_out = {}) const;

  /// The error of a sample's prediction.
  struct Miss {
    double square = 0;    ///< (difference of logarithms)^2 over its expected variance, mean over channels
    double distance = 0;  ///< |difference of logarithms|, mean over channels
  };
  /// Precondition: another sample is not left out.
  Miss miss(std::size_t i, std::span<const std::uint8_t> left_out = {}) const;

 private:
  double log_of(std::size_t i, std::size_t channel) const noexcept { return logs_[i * channels_ + channel]; }

  LogCovariance covariance_;
  std::size_t channels_;
  KdTree tree_;                      // places over the lengths of the term that sees all
  std::vector<std::size_t> number_;  // everything in the tree's order
  std::vector<TreePoint> places_;
  std::vector<double> logs_;  // [sample][channel]
};

/// The errors of samples predicted from the others: |ln f - prediction|, at most 1 each, mean over up to 2,000 of up
/// to 50,000 samples. They are taken once as isotropic and once as anisotropic; the smaller error tells which they
/// are.
struct IsotropyErrors {
  double isotropic = 0, anisotropic = 0;
};
/// Computes both errors. They are 0 for fewer than 2 kPredicting samples, which do not tell. Deterministic.
IsotropyErrors isotropy_errors(const Samples& samples);

}  // namespace burnish
