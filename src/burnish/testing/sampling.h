// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include <burnish/math/random.h>
#include <burnish/parameterization/visible_half.h>
#include <burnish/reflectance/sampling.h>

namespace burnish {

/// Views from the normal to near the horizon.
inline const Vec3 kViews[] = {
    {0, 0, 1}, spherical_direction(0.6, 1), spherical_direction(1.2, 4), spherical_direction(1.54, 2)};

/// Returns the probability that a chi-square variable of `degrees` degrees of freedom exceeds x. It is the regularized
/// upper incomplete gamma function Q(degrees / 2, x / 2), by its series or its continued fraction.
inline double chi_square_tail(double x, int degrees) noexcept {
  const double a = 0.5 * degrees, z = 0.5 * x, front = std::exp(a * std::log(z) - z - std::lgamma(a));
  if (z < a + 1) {
    double term = 1 / a, sum = term;
    for (double k = a + 1; term > 1e-15 * sum; ++k) sum += term *= z / k;
    return 1 - front * sum;
  }
  double b = z + 1 - a, c = 1e300, d = 1 / b, fraction = d;
  for (int i = 1; i < 1000; ++i) {
    const double numerator = i * (a - i);
    b += 2;
    d = 1 / (numerator * d + b);
    c = b + numerator / c;
    fraction *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return front * fraction;
}

/// The results of a test that compares a histogram of drawn directions with a sampler's pdf.
struct DrawTest {
  double p_value;   ///< of the histogram, if the pdf is that of the draws
  double integral;  ///< of pdf over the upper hemisphere
};

/// The bins of half vectors that test_draws counts in, kSide x kSide of them and one below the horizon. They
/// are even in the azimuth and in the root of log(1 + 1000 tan^2(theta_h / 2)). They end where the mirror of
/// wo meets the horizon. So both highlights and tails have some bins.
struct HalfVectorBins {
  static constexpr int kSide = 12, kPoints = 600;
  static constexpr double kSpread = 1000;
  Vec3 wo;

  /// Returns log(1 + 1000 tan^2(theta_h / 2)) at the horizon.
  double largest(double phi) const noexcept {
    return std::log1p(kSpread * largest_visible_half(wo.x * std::cos(phi) + wo.y * std::sin(phi), wo.z));
  }
  std::size_t count() const noexcept { return kSide * kSide + 1; }

  /// Returns the integral of pdf over each bin, by kPoints points of a lattice. Borders of cells that are
  /// parallel to the bins do not mislead a lattice.
  std::vector<double> integrals(SamplerRef sampler) const {
    std::vector<double> shares(count());
    for (int bin = 0; bin < kSide * kSide; ++bin)
      for (int k = 0; k < kPoints; ++k) {
        const double golden = 0.6180339887498949 * (k + kPoints * bin);
        const double phi = kTwoPi * (bin / kSide + (k + 0.5) / kPoints) / kSide, v = largest(phi);
        const double place = (bin % kSide + golden - std::floor(golden)) / kSide;
        const double m = std::expm1(v * place * place) / kSpread;
        const Vec3 h = spherical_direction(2 * std::atan(std::sqrt(m)), phi);
        // This is dm dphi of a bin, with solid angles as in half_vector_quadrature.
        const double area = (m + 1 / kSpread) * 2 * v * place * kTwoPi / (kSide * kSide);
        const double solid_angle = 8 * dot(wo, h) * area / ((1 + m) * (1 + m)) / kPoints;
        shares[static_cast<std::size_t>(bin)] += sampler.pdf(2 * dot(wo, h) * h - wo, wo) * solid_angle;
      }
    return shares;
  }

  /// Returns the bin of a draw.
  std::size_t of(const DrawnDirection& drawn) const noexcept {
    if (!(drawn.wi.z > 0 && drawn.pdf > 0)) return kSide * kSide;
    const Vec3 h = half_vector(drawn.wi, wo);
    const double phi = phi_of(h), t = std::sqrt(h.x * h.x + h.y * h.y) / (1 + h.z);
    const auto index = [](double place) { return std::clamp(static_cast<int>(place * kSide), 0, kSide - 1); };
    return static_cast<std::size_t>(index(phi / kTwoPi) * kSide +
                                    index(std::sqrt(std::log1p(kSpread * t * t) / largest(phi))));
  }
};

/// Returns the p-value of Pearson's chi-square test of counts. Bins of fewer than five expected counts are joined. If
/// the joined bins expect fewer than five too, they may hold no more than 25 counts; otherwise the p-value is 0.
inline double chi_square_p_value(std::span<const double> expected, std::span<const double> seen) noexcept {
  double statistic = 0, rest_expected = 0, rest_seen = 0;
  int bins = 0;
  const auto add = [&](double e, double s) {
    statistic += (s - e) * (s - e) / e;
    ++bins;
  };
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (expected[i] >= 5) {
      add(expected[i], seen[i]);
    } else {
      rest_expected += expected[i];
      rest_seen += seen[i];
    }
  if (rest_expected >= 5)
    add(rest_expected, rest_seen);
  else if (rest_seen > 25)
    return 0;
  return bins > 1 ? chi_square_tail(statistic, bins - 1) : 1;
}

/// Draws `draws` directions for wo. Compares the count in each of HalfVectorBins with the integral of pdf over the bin.
inline DrawTest test_draws(SamplerRef sampler, Vec3 wo, int draws, std::uint64_t seed) {
  const HalfVectorBins bins{wo};
  std::vector<double> expected = bins.integrals(sampler);
  const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
  for (double& e : expected) e *= draws;
  expected.back() = std::max(1 - total, 0.0) * draws;

  Pcg32 random(seed);
  std::vector<double> seen(bins.count());
  for (int n = 0; n < draws; ++n) {
    const double x = random.uniform(), y = random.uniform();
    ++seen[bins.of(sampler.sample_wi(wo, {x, y}))];
  }
  return {chi_square_p_value(expected, seen), total};
}

/// Returns the level of each of `count` tests at which all pass with probability 1 - `level` (Sidak).
inline double level_of_each(double level, int count) noexcept {
  return -std::expm1(std::log1p(-level) / count);
}

}  // namespace burnish
