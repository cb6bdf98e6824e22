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
/// Near the horizon BRDFs rise by a power of the cosines, and instruments stop before it. A last term lets the exponent
/// vary slowly from place to place, so that the rise that was measured goes on beyond the last measurement:
///   grazing^2 g(a) g(b) m(|a - b|_grazing),   g the grazing measure below.
/// Source: [Rasmussen 2006, eq. 4.17]; a term that is linear in g with a coefficient that varies is eq. 2.39 times it.
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
  std::array<double, kAxes> grazing_inverse_length{};  ///< of the exponent
  double noise;  ///< standard deviation of a measured ln f of weight 1, > 0

  /// Returns the variance of ln f where nothing is measured, away from the horizon or at a grazing measure.
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

/// Returns the grazing measure of directions above the horizon: the sum over both of ln(0.2 / cos), at least 0 and at
/// most that of a cosine of 0.005, so values stay bounded at the horizon.
double grazing_measure(Vec3 wi, Vec3 wo) noexcept;

}  // namespace burnish
