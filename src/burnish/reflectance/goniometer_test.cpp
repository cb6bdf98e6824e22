// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

TEST(DrawPairs, IsRepeatableAndAPrefixOfALongerDraw) {
  const auto few = draw_pairs(100, 7, false), many = draw_pairs(1000, 7, false);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
  EXPECT_NE(few, draw_pairs(100, 8, false));
}

TEST(DrawPairs, KeepsBothDirectionsAboveTheHorizonAndOfUnitLength) {
  for (const bool isotropic : {false, true})
    for (const auto& [wi, wo] : draw_pairs(10000, 1, isotropic)) {
      EXPECT_GT(wi.z, kDrawnCosine);
      EXPECT_GT(wo.z, kDrawnCosine);
      EXPECT_NEAR(length(wi), 1, 1e-14);
      EXPECT_NEAR(length(wo), 1, 1e-14);
    }
}

TEST(DrawPairs, KeepsTheHalfVectorOverTheTangentWhereIsotropic) {
  for (const auto& [wi, wo] : draw_pairs(1000, 1, true)) {
    EXPECT_NEAR(half_vector(wi, wo).y, 0, 1e-14);
    EXPECT_GE(half_vector(wi, wo).x, 0);
  }
}

// Small theta_h and theta_d are never rejected, so there the angles must show their uniform densities.
TEST(DrawPairs, IsUniformInHalfAndDifferenceAngles) {
  std::size_t low_h = 0, low_d = 0, half_phi_d = 0, half_phi_h = 0, total = 0;
  for (const auto& [wi, wo] : draw_pairs(200000, 3, false)) {
    const HalfDiff angles = to_half_diff(wi, wo);
    if (angles.theta_h > radians(40) || angles.theta_d > radians(40)) continue;
    ++total;
    low_h += angles.theta_h < radians(10);
    low_d += angles.theta_d < radians(10);
    half_phi_d += angles.phi_d < kPi;
    half_phi_h += angles.phi_h < kPi;
  }
  const double n = static_cast<double>(total), sigma4 = 4 * 0.5 / std::sqrt(n);
  EXPECT_NEAR(static_cast<double>(low_h) / n, 0.25, sigma4);
  EXPECT_NEAR(static_cast<double>(low_d) / n, 0.25, sigma4);
  EXPECT_NEAR(static_cast<double>(half_phi_d) / n, 0.5, sigma4);
  EXPECT_NEAR(static_cast<double>(half_phi_h) / n, 0.5, sigma4);
}

/// Known where wo.x > 0.
struct HalfKnown {
  std::size_t channels() const noexcept { return 2; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    f[0] = wi.z;
    f[1] = 1;
    return wo.x > 0;
  }
};

struct Unknown {
  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3, Vec3, std::span<double>) const noexcept { return false; }
};

TEST(Measure, ReturnsTheSourceAtKnownPairs) {
  const Samples samples = measure(HalfKnown{}, {500, 0, 3});
  ASSERT_EQ(samples.size(), 500u);
  EXPECT_TRUE(samples.isotropic);
  for (std::size_t i = 0; i < 500; ++i) {
    EXPECT_GT(samples.pairs[i].wo.x, 0);
    EXPECT_EQ(samples.at(i)[0], samples.pairs[i].wi.z);
  }
}

TEST(Measure, MultipliesLogNormalNoise) {
  const double sigma = 0.2;
  const Samples samples = measure(HalfKnown{}, {20000, sigma, 3});
  double sum = 0, square = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double log = std::log(samples.at(i)[1]);
    sum += log;
    square += log * log;
  }
  const double n = static_cast<double>(samples.size());
  EXPECT_NEAR(sum / n, 0, 4 * sigma / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(square / n), sigma, 4 * sigma / std::sqrt(2 * n));
  EXPECT_EQ(measure(HalfKnown{}, {20000, sigma, 3}).values, samples.values);
  EXPECT_NE(measure(HalfKnown{}, {20000, sigma, 4}).values, samples.values);
}

TEST(Measure, RefusesBadNoiseAndASourceThatKnowsNothing) {
  EXPECT_THROW(measure(HalfKnown{}, {10, -1, 1}), Error);
  EXPECT_THROW(measure(HalfKnown{}, {10, std::nan(""), 1}), Error);
  EXPECT_THROW(measure(Unknown{}, {10, 0, 1}), Error);
}

}  // namespace
}  // namespace burnish
