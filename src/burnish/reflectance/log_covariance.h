#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <burnish/math/kd_tree.h>

namespace burnish {

/// How alike the logarithms of a BRDF are at two places: a Gaussian process, whose covariance is a sum of terms
///   k(a, b) = level^2 + sum_t spread_t^2 m(|a - b|_t),   m(r) = (1 + sqrt(3) r) exp(-sqrt(3) r)
/// (Matern, smoothness 3/2), |.|_t the distance in the coordinates of term t, each divided by a length.
/// Coordinates of an isotropic BRDF, even in the exchange and in the reflection of the directions:
///   (sqrt(tan(theta_h/2)), tan(theta_d/2), sin(theta_d) phi_d / (pi/2)), phi_d folded into [0, pi/2];
/// its terms see the first, the first two, and all three. Coordinates of an anisotropic one, even in the exchange:
///   the half vector at radius sqrt(tan(theta_h/2)), the difference vector at radius tan(theta_d/2) and twice its
///   azimuth; its terms see the half vector, the difference vector, and both.
/// Source: [Rasmussen 2006, eq. 4.17 and 5.8].
struct LogCovariance {
  static constexpr std::size_t kTerms = 3, kAxes = 4;
  static constexpr double kRoot3 = 1.7320508075688772;

  /// Lengths, spreads and noise of a smooth BRDF that was measured well: for few measurements, and what likelihood
  /// starts from.
  explicit LogCovariance(bool isotropic) noexcept;

  double level;                                    ///< standard deviation of the mean of ln f, > 0
  std::array<double, kTerms> spread;               ///< standard deviations of the terms, > 0
  std::array<TreePoint, kTerms> inverse_length{};  ///< 0 where a term does not see a coordinate
  double noise;                                    ///< standard deviation of a measured ln f of weight 1, > 0

  /// The variance of ln f where nothing is measured.
  double variance() const noexcept;

  friend bool operator==(const LogCovariance&, const LogCovariance&) = default;
};

/// Measured logarithms at places among the coordinates of LogCovariance.
struct LogMeasurements {
  std::size_t channels = 0;
  std::vector<TreePoint> places;
  std::vector<double> logs;       ///< less the mean of each channel, [place][channel]
  std::vector<double> variances;  ///< of the noise, in units of noise^2

  std::size_t size() const noexcept { return places.size(); }
};

/// The covariance under which the measurements of each block are likeliest, blocks taken as independent, beside a prior
/// that keeps parameters within a factor of e^4 of the default. Found by steps whose sizes follow the signs of the
/// gradient [Riedmiller 1993]. The cost is that of a few dense matrices of the size of each block a step.
/// Deterministic, whatever the number of threads.
LogCovariance likeliest_covariance(const LogMeasurements& measured,
                                   std::span<const std::vector<std::size_t>> blocks, bool isotropic);

}  // namespace burnish
