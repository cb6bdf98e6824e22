#include <gtest/gtest.h>

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

}  // namespace
}  // namespace burnish
