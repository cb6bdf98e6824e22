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

/// The function behind measured points: ln(f + 1e-3) at a pair of directions is the best linear prediction from
/// kNeighbours nodes near it under a covariance (kriging). It is as rough as the points say, goes to their mean where
/// there are none, and knows how uncertain it is. Pairs share the neighbours of the node that is nearest to them, one of
/// at most kCentres, so a pair costs kNeighbours covariances. Nodes nearer to the horizon are taken as noisier; a node's
/// weight divides the variance of its noise. Values lie between 0 and twice the largest node's.
/// Exchanged directions and, of an isotropic source, mirror images give the same to the rounding of floats.
/// Source: [Rasmussen 2006, eq. 2.25 and 2.26].
class KrigedNodes {
 public:
  static constexpr double kFloor = 1e-3;        ///< 1/sr, as in the figure `relative`
  static constexpr double kLeastCosine = 0.02;  ///< of both directions of a node that is used
  static constexpr std::size_t kNeighbours = 64, kCentres = 1 << 15, kCalibrating = 32;

  /// Throws Error where none of the nodes has both cosines above kLeastCosine.
  /// With `few_pairs` nothing is prepared for sharing, and eval takes each pair's own neighbours.
  KrigedNodes(const MeasuredNodes& nodes, const LogCovariance& covariance, bool few_pairs = false);

  std::size_t channels() const noexcept { return measured_.channels; }
  bool isotropic() const noexcept { return isotropic_; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  /// The same from the nodes whose numbers in the constructor's order `takes` accepts.
  void eval_from(Vec3 wi, Vec3 wo, const std::function<bool(std::size_t node)>& takes,
                 std::span<double> f) const noexcept;

  /// How far ln(f + 1e-3) at a pair of directions may be off: standard deviations, >= 0, of the function and of what an
  /// instrument would read there, noise included. The covariance gives them, times the root of the mean square by which
  /// the kCalibrating nearest nodes surprise those around them, in units of what the covariance expects: a covariance is
  /// one for all directions, and where a source is rougher its nodes say so. Both 0 below the horizon.
  LogUncertainty uncertainty(Vec3 wi, Vec3 wo) const noexcept;

  /// Covariances of ln f at a pair with ln f at others, given the kNeighbours nodes nearest to the one; above the
  /// horizon, and without the calibration of uncertainty.
  void covariances_with(const DirectionPair& one, std::span<const DirectionPair> others,
                        std::span<double> covariances) const noexcept;
  /// What the squares of uncertainty are multiplied by, >= 0.
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

  bool isotropic_ = true;
  LogCovariance covariance_;
  KdTree tree_;                      // places scaled by the lengths of the term that sees all
  LogMeasurements measured_;         // in the tree's order
  std::vector<std::uint32_t> node_;  // what number each had
  KdTree centres_;                   // nodes whose neighbours others share
  std::vector<std::uint32_t> near_;  // these neighbours, [centre][neighbour]
  std::vector<float> solved_;        // K^-1 y of these, [centre][neighbour][channel]
  std::vector<float> calibration_;   // of variances, [centre]
  std::vector<double> mean_;         // of the logarithms, [channel]
  std::vector<double> largest_;      // f, [channel]
};

static_assert(Brdf<KrigedNodes>);

/// A pair of directions among the coordinates of LogCovariance. Precondition: both above the horizon.
TreePoint place_of(Vec3 wi, Vec3 wo, bool isotropic) noexcept;

/// Covariances that are likely: of groups of near nodes, which tell how rough the source is, and of nodes from
/// everywhere, which tell how it changes from place to place. At least one.
/// Throws Error where no node has both cosines above 0.02.
std::vector<LogCovariance> likely_covariances(const MeasuredNodes& nodes);

/// `fitted` and, where no node of `all` lies near, what `function` says there, at a tenth of a node's weight:
/// instruments leave whole regions out (wide half angles, the neighbourhood of the normal), and what stands
/// there is a guess anyway. Both are isotropic and have the function's channels.
MeasuredNodes with_gaps_filled(const MeasuredNodes& fitted, const MeasuredNodes& all, BrdfRef function);

}  // namespace burnish
