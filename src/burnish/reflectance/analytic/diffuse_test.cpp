// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/reflectance/analytic/diffuse.h>
#include <burnish/testing/albedo.h>
#include <burnish/testing/analytic_values.h>

namespace burnish {
namespace {

using fixtures::at;
using fixtures::grey;
using fixtures::kA;
using fixtures::kB;
using fixtures::kNormal;

TEST(Lambert, IsConstant) {
  EXPECT_DOUBLE_EQ(grey(Lambert{0.7}, kA, kB), 0.7 / kPi);
}

TEST(OrenNayar, HasItsClosedFormAtNormalIncidence) {
  // beta = 0 leaves C1 and the interreflection.
  const double s2 = 0.36, rho = 0.7;
  const double expected =
      rho / kPi * (1 - 0.5 * s2 / (s2 + 0.33)) + 0.17 * rho * rho / kPi * s2 / (s2 + 0.13);
  EXPECT_NEAR(grey(OrenNayar{rho, 0.6}, kNormal, at(70, 30)), expected, 1e-14);
  EXPECT_DOUBLE_EQ(grey(OrenNayar{rho, 0}, kA, kB), rho / kPi);
}

TEST(OrenNayar, MatchesReferenceValuesForwardAndBackward) {
  EXPECT_NEAR(grey(OrenNayar{0.7, 0.6}, kA, kB), 0.1524495760831324, 1e-14);
  EXPECT_NEAR(grey(OrenNayar{0.7, 0.6}, at(60, 0), at(40, 30)), 0.2316318931923341, 1e-14);
}

TEST(OrenNayar, ConservesLightUpToAnAlbedoOfNineTenths) {
  for (const double sigma : {0.1, 0.275, 0.6, 1.5})
    for (const double theta_deg : {0.0, 40.0, 70.0, 85.0})
      EXPECT_LT((albedo<48, 64>)(OrenNayar{0.9, sigma}, at(theta_deg, 0)), 0.95) << sigma;
  EXPECT_GT(albedo(OrenNayar{1, 0.275}, at(85, 0)), 1.01);
}

}  // namespace
}  // namespace burnish
