// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/testing/sampling.h>

namespace burnish {
namespace {

TEST(ChiSquareTail, HasTheValuesOfTables) {
  EXPECT_NEAR(chi_square_tail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(chi_square_tail(10, 2), std::exp(-5.0), 1e-12);
  EXPECT_NEAR(chi_square_tail(124.3421134, 100), 0.05, 1e-8);
}

TEST(LargestVisibleHalf, MirrorsWoOntoTheHorizon) {
  Pcg32 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wo =
        spherical_direction(kHalfPi * (1 - std::pow(10.0, -6 * random.uniform())), kTwoPi * random.uniform());
    const double phi = kTwoPi * random.uniform(), x = std::cos(phi), y = std::sin(phi);
    const double t = std::sqrt(largest_visible_half(wo.x * x + wo.y * y, wo.z));
    const Vec3 h = Vec3{2 * t * x, 2 * t * y, 1 - t * t} * (1 / (1 + t * t));
    EXPECT_NEAR((2 * dot(wo, h) * h - wo).z, 0, 1e-12);
  }
}

TEST(CosineSampler, DrawsByItsDensity) {
  const DrawTest test = test_draws(CosineSampler{}, kViews[1], 50'000, 2);
  EXPECT_GT(test.p_value, 0.01);
  EXPECT_NEAR(test.integral, 1, 1e-3);
}

}  // namespace
}  // namespace burnish
