// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/math/random.h>
#include <burnish/reflectance/likeliest_covariance.h>

namespace burnish {
namespace {

double normal(Pcg32& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

/// Values of a line that turns `turns` times over theta_h, with noise.
LogMeasurements of_a_wave(double turns, double noise, std::size_t count) {
  LogMeasurements measured{.channels = 1};
  Pcg32 random(3);
  for (std::size_t i = 0; i < count; ++i) {
    measured.places.push_back({random.uniform(), random.uniform(), random.uniform(), 0});
    measured.logs.push_back(std::sin(6.2831853 * turns * measured.places.back()[0]) + noise * normal(random));
    measured.variances.push_back(1);
  }
  return measured;
}

std::vector<std::vector<std::size_t>> one_block(std::size_t count) {
  std::vector<std::vector<std::size_t>> blocks(1);
  for (std::size_t i = 0; i < count; ++i) blocks[0].push_back(i);
  return blocks;
}

TEST(LogCovariance, FindsTheNoise) {
  for (const double noise : {0.02, 0.1, 0.3}) {
    const LogMeasurements measured = of_a_wave(1, noise, 300);
    EXPECT_NEAR(std::log(likeliest_covariance(measured, one_block(300), true).noise / noise), 0, 0.25);
  }
}

TEST(LogCovariance, IsRougherWhereValuesAre) {
  // variance of a step of theta_h: each term's share of how fast its covariance falls
  const auto roughness = [](const LogCovariance& covariance) {
    double sum = 0;
    for (std::size_t t = 0; t < LogCovariance::kTerms; ++t)
      sum += std::pow(covariance.spread[t] * covariance.inverse_length[t][0], 2);
    return sum;
  };
  const LogCovariance calm = likeliest_covariance(of_a_wave(0.5, 0.05, 250), one_block(250), true),
                      rough = likeliest_covariance(of_a_wave(4, 0.05, 250), one_block(250), true);
  EXPECT_GT(roughness(rough), 10 * roughness(calm));
}

TEST(LogCovariance, DefaultSeesCoordinatesAsItsTermsSay) {
  const LogCovariance isotropic = LogCovariance(true), anisotropic = LogCovariance(false);
  EXPECT_EQ(isotropic.inverse_length[0][1], 0);
  EXPECT_GT(isotropic.inverse_length[2][2], 0);
  EXPECT_EQ(isotropic.inverse_length[2][3], 0);
  EXPECT_EQ(anisotropic.inverse_length[1][0], 0);
  EXPECT_GT(anisotropic.inverse_length[2][3], 0);
  EXPECT_NEAR(isotropic.variance(), 4 + 3 * 2.25, 1e-12);
}

}  // namespace
}  // namespace burnish
