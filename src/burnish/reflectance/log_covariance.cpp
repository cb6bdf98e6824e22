// SPDX-License-Identifier: Apache-2.0
#include <burnish/reflectance/log_covariance.h>

namespace burnish {

namespace {

using Lengths = std::array<std::array<double, LogCovariance::kAxes>, LogCovariance::kTerms>;

// Lengths of a smooth BRDF that was measured well.
constexpr Lengths kIsotropicLengths{{{0.4, 0, 0, 0}, {0.7, 0.7, 0, 0}, {0.4, 0.9, 1.5, 0}}};
constexpr Lengths kAnisotropicLengths{{{0.4, 0.4, 0, 0}, {0, 0, 0.7, 0.7}, {0.5, 0.5, 0.9, 0.9}}};
constexpr double kUsualLevel = 2, kUsualSpread = 1.5, kUsualNoise = 0.06;

}  // namespace

LogCovariance::LogCovariance(bool isotropic) noexcept : level(kUsualLevel), noise(kUsualNoise) {
  spread.fill(kUsualSpread);
  const auto& lengths = isotropic ? kIsotropicLengths : kAnisotropicLengths;
  for (std::size_t t = 0; t < kTerms; ++t)
    for (std::size_t k = 0; k < kAxes; ++k)
      if (lengths[t][k] > 0) inverse_length[t][k] = 1 / lengths[t][k];
}

double LogCovariance::variance() const noexcept {
  double sum = level * level;
  for (const double of_term : spread) sum += of_term * of_term;
  return sum;
}

}  // namespace burnish
