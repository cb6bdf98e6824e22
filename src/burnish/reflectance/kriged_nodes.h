// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <burnish/math/kd_tree.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/likeliest_covariance.h>
#include <burnish/reflectance/measured_nodes.h>

namespace burnish {

/// Standard deviations of ln(f + 1e-3).
struct LogUncertainty {
  double function = 0, reading = 0;
};

/// A function through measured nodes: ln(f + 1e-3) at a pair of directions is the best linear prediction from the
/// nearest kNeighbours nodes under a covariance (kriging). The function is as rough as the nodes are, tends to their
/// mean far from them, and gives its uncertainty. Near the horizon it goes on rising as the last nodes do.
/// Pairs share the neighbours of the nearest centre, one of at most kCentres nodes, so a pair costs kNeighbours
/// covariances. Nodes nearer to the horizon are taken as noisier; a node's weight divides the variance of its noise.
/// Values lie between 0 and twice the largest node's.
/// Exchanged directions and, for an isotropic source, mirror images give the same to the rounding of floats.
/// Source: [Rasmussen 2006, eq. 2.25 and 2.26].
class KrigedNodes {
 public:
  static constexpr double kFloor = 1e-3;        ///< 1/sr, as in the figure `relative`
  static constexpr double kLeastCosine = 0.02;  ///< least cosine of both directions of a node that is used
  static constexpr std::size_t kNeighbours = 192, kFewPairsNeighbours = 128;
  static constexpr std::size_t kCentres = 1 << 13, kCalibrating = 32;

  /// Throws Error where none of the nodes has both cosines above kLeastCosine.
  /// With `few_pairs` nothing is prepared for sharing, and eval takes each pair's own kFewPairsNeighbours nodes.
  KrigedNodes(const MeasuredNodes& nodes, const LogCovariance& covariance, bool few_pairs = false);

  std::size_t channels() const noexcept { return measured_.channels; }
  bool isotropic() const noexcept { return isotropic_; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  /// Evaluates from the nodes whose numbers in the constructor's order `takes` accepts.
  void eval_from(Vec3 wi, Vec3 wo, const std::function<bool(std::size_t node)>& takes,
                 std::span<double> f) const noexcept;

  /// Returns standard deviations >= 0 of ln(f + 1e-3) at a pair of directions: of the function, and of an
  /// instrument's reading there, noise included. Both are 0 below the horizon.
  /// The covariance gives them, times a calibration: the root of the mean squared leave-one-out residual of the
  /// nearest centres, at most kCalibrating, over the variance that the covariance expects. One covariance serves all
  /// directions; the calibration adapts it to where a source is rougher.
  LogUncertainty uncertainty(Vec3 wi, Vec3 wo) const noexcept;

  /// Computes the covariances of ln f at one pair with ln f at others, given the kNeighbours nodes nearest to the
  /// one. All are above the horizon. The calibration of uncertainty() is not applied.
  void covariances_with(const DirectionPair& one, std::span<const DirectionPair> others,
                        std::span<double> covariances) const noexcept;
  /// Returns the factor of the squares in uncertainty(), >= 0.
  double calibration(const DirectionPair& pair) const noexcept;

 private:
  struct Neighbourhood;
  template <class Takes>
  Neighbourhood neighbourhood(const TreePoint& scaled_place, const Takes& takes) const noexcept;
  void solve_centres();
  static double surprise_of(const Neighbourhood& near, std::uint32_t node, std::span<const float> solved);
  void calibrate(std::span<const double> surprises);
  double value_of(double log, std::size_t channel) const noexcept;
  TreePoint scaled(TreePoint place) const noexcept;

  bool isotropic_ = true, few_pairs_ = false;
  LogCovariance covariance_;
  KdTree tree_;                      // places scaled by the lengths of the term that sees all
  LogMeasurements measured_;         // in the tree's order
  std::vector<std::uint32_t> node_;  // number that each had in the constructor's order
  KdTree centres_;                   // nodes whose neighbours others share
  std::vector<std::uint32_t> near_;  // these neighbours, [centre][neighbour]
  std::vector<float> solved_;        // K^-1 y of these, [centre][neighbour][channel]
  std::vector<float> calibration_;   // of variances, [centre]
  std::vector<double> mean_;         // of the logarithms, [channel]
  std::vector<double> largest_;      // f, [channel]
};

static_assert(Brdf<KrigedNodes>);

/// Returns the coordinates of a pair of directions that LogCovariance defines. Precondition: both are above the
/// horizon.
TreePoint place_of(Vec3 wi, Vec3 wo, bool isotropic) noexcept;

/// Returns likely covariances, at least one. Groups of near nodes tell how rough the source is, nodes from everywhere
/// how it changes from place to place. Throws Error where no node has both cosines above 0.02.
std::vector<LogCovariance> likely_covariances(const MeasuredNodes& nodes);

/// Returns `fitted` and, where no node of `all` lies near, values of `function` at a tenth of a node's weight.
/// Instruments leave whole regions out (wide half angles, the neighbourhood of the normal), and any value there is a
/// guess. Both are isotropic and have the function's channels.
MeasuredNodes with_gaps_filled(const MeasuredNodes& fitted, const MeasuredNodes& all, BrdfRef function);

}  // namespace burnish
