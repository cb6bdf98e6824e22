// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/reflectance/log_covariance.h>

namespace burnish {

namespace {

using Lengths = std::array<std::array<double, LogCovariance::kAxes>, LogCovariance::kTerms>;

// Lengths of a smooth BRDF that was measured well.
constexpr Lengths kIsotropicLengths{{{0.4, 0, 0, 0}, {0.7, 0.7, 0, 0}, {0.4, 0.9, 1.5, 0}}};
constexpr Lengths kAnisotropicLengths{{{0.4, 0.4, 0, 0}, {0, 0, 0.7, 0.7}, {0.5, 0.5, 0.9, 0.9}}};
constexpr double kUsualLevel = 2, kUsualSpread = 1.5, kUsualNoise = 0.06;

// Standard deviation of the exponent. Most BRDFs have exponents from 0, where f is finite at the horizon, to 1, where
// f cos is.
constexpr double kUsualGrazing = 0.5;
constexpr std::array<double, LogCovariance::kAxes> kIsotropicGrazing{1, 1.4, 3, 0},
    kAnisotropicGrazing{1, 1, 1.4, 1.4};
constexpr double kGrazingCosine = 0.2, kLeastGrazingCosine = 0.005;

}  // namespace

LogCovariance::LogCovariance(bool isotropic) noexcept
    : level(kUsualLevel), grazing(kUsualGrazing), noise(kUsualNoise) {
  spread.fill(kUsualSpread);
  const auto& lengths = isotropic ? kIsotropicLengths : kAnisotropicLengths;
  for (std::size_t t = 0; t < kTerms; ++t)
    for (std::size_t k = 0; k < kAxes; ++k)
      if (lengths[t][k] > 0) inverse_length[t][k] = 1 / lengths[t][k];
  const auto& of_exponent = isotropic ? kIsotropicGrazing : kAnisotropicGrazing;
  for (std::size_t k = 0; k < kAxes; ++k)
    if (of_exponent[k] > 0) grazing_inverse_length[k] = 1 / of_exponent[k];
}

namespace {

/// Returns the Matern function of smoothness 3/2 of the distance of two places [Rasmussen 2006, eq. 4.17].
double matern(const std::array<double, LogCovariance::kAxes>& inverse_length,
              const std::array<double, LogCovariance::kAxes>& a,
              const std::array<double, LogCovariance::kAxes>& b) noexcept {
  double r2 = 0;
  for (std::size_t k = 0; k < LogCovariance::kAxes; ++k) {
    const double d = (a[k] - b[k]) * inverse_length[k];
    r2 += d * d;
  }
  const double r = LogCovariance::kRoot3 * std::sqrt(r2);
  return (1 + r) * std::exp(-r);
}

}  // namespace

double LogCovariance::between(const std::array<double, kAxes>& a,
                              const std::array<double, kAxes>& b) const noexcept {
  double sum = level * level;
  for (std::size_t t = 0; t < kTerms; ++t) sum += spread[t] * spread[t] * matern(inverse_length[t], a, b);
  return sum;
}

double LogCovariance::grazing_between(const std::array<double, kAxes>& a, double grazing_a,
                                      const std::array<double, kAxes>& b, double grazing_b) const noexcept {
  const double both = grazing_a * grazing_b;
  return both == 0 ? 0 : grazing * grazing * both * matern(grazing_inverse_length, a, b);
}

double LogCovariance::variance() const noexcept {
  double sum = level * level;
  for (const double of_term : spread) sum += of_term * of_term;
  return sum;
}

double grazing_measure(Vec3 wi, Vec3 wo) noexcept {
  const auto of = [](double cosine) {
    return cosine < kGrazingCosine ? std::log(kGrazingCosine / std::max(cosine, kLeastGrazingCosine)) : 0;
  };
  return of(wi.z) + of(wo.z);
}

}  // namespace burnish
