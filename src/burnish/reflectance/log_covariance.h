// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <burnish/math/vec3.h>

namespace burnish {

/// The covariance of a BRDF's logarithms at two places: a Gaussian process, whose covariance is a sum of terms
///   k(a, b) = level^2 + sum_t spread_t^2 m(|a - b|_t),   m(r) = (1 + sqrt(3) r) exp(-sqrt(3) r)
/// (Matern, smoothness 3/2). |.|_t is the distance in the coordinates of term t, each divided by a length.
/// Coordinates of an isotropic BRDF are even in the exchange and in the reflection of the directions:
///   (sqrt(tan(theta_h/2)), tan(theta_d/2), sin(theta_d) phi_d / (pi/2)), phi_d folded into [0, pi/2];
/// its terms see the first, the first two, and all three. Coordinates of an anisotropic one are even in the exchange:
///   the half vector at radius sqrt(tan(theta_h/2)), the difference vector at radius tan(theta_d/2) and twice its
///   azimuth; its terms see the half vector, the difference vector, and both.
/// Near the horizon BRDFs rise by a power of the cosines, and instruments stop before the horizon. The grazing term
/// lets the exponent vary slowly from place to place. So a rise that was measured goes on beyond the last measurement:
///   grazing^2 g(a) g(b) m(|a - b|_grazing),   g(a) the grazing measure of the directions at a.
/// Sources: [Rasmussen 2006, eq. 4.17] for m; the grazing term is the basis function g of eq. 2.39 with a coefficient
/// that has the covariance grazing^2 m.
struct LogCovariance {
  static constexpr std::size_t kTerms = 3, kAxes = 4;
  static constexpr double kRoot3 = 1.7320508075688772;

  /// Sets lengths, spreads and noise of a smooth BRDF that was measured well. They serve few measurements, and start
  /// the search for likelier ones.
  explicit LogCovariance(bool isotropic) noexcept;

  double level;                       ///< standard deviation of the mean of ln f, > 0
  std::array<double, kTerms> spread;  ///< standard deviations of the terms, > 0
  /// One inverse length for each term and coordinate; 0 where the term does not see it.
  std::array<std::array<double, kAxes>, kTerms> inverse_length{};
  double grazing;  ///< standard deviation of the exponent of the cosines near the horizon, >= 0
  std::array<double, kAxes> grazing_inverse_length{};  ///< of the exponent, along each coordinate
  double noise;  ///< standard deviation of a measured ln f of weight 1, > 0

  /// Returns the variance of ln f where nothing is measured: away from the horizon, or at a grazing measure.
  double variance() const noexcept;
  double variance(double grazing_measure) const noexcept {
    return variance() + grazing * grazing * grazing_measure * grazing_measure;
  }

  /// Returns the covariance of ln f at two places away from the horizon, in the coordinates above.
  double between(const std::array<double, kAxes>& a, const std::array<double, kAxes>& b) const noexcept;
  /// Returns what the grazing term adds, given the grazing measures of the places.
  double grazing_between(const std::array<double, kAxes>& a, double grazing_a,
                         const std::array<double, kAxes>& b, double grazing_b) const noexcept;

  friend bool operator==(const LogCovariance&, const LogCovariance&) = default;
};

/// Returns the grazing measure of directions above the horizon: the sum over both of ln(0.2 / cos), 0 for a cosine
/// above 0.2. A cosine below 0.005 counts as 0.005, so values stay bounded at the horizon.
double grazing_measure(Vec3 wi, Vec3 wo) noexcept;

}  // namespace burnish
