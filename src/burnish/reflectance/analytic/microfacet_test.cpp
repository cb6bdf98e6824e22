// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/reflectance/analytic/microfacet.h>
#include <burnish/testing/albedo.h>
#include <burnish/testing/analytic_values.h>

namespace burnish {
namespace {

using fixtures::at;
using fixtures::grey;
using fixtures::kA;
using fixtures::kB;
using fixtures::kNormal;

TEST(Microfacet, HasItsClosedFormAtNormalIncidence) {
  EXPECT_NEAR(grey(Ggx{{0.2, 0.5}, 0.7, 0.1}, kNormal, kNormal), 0.7 / (4 * kPi * 0.1) + 0.1 / kPi, 1e-14);
  EXPECT_NEAR(grey(Beckmann{{0.2, 0.5}, 0.7, 0.1}, kNormal, kNormal), 0.7 / (4 * kPi * 0.1) + 0.1 / kPi,
              1e-14);
}

TEST(Microfacet, MatchesReferenceValues) {
  EXPECT_NEAR(grey(Ggx{{0.3, 0.5}, 0.4, 0}, kA, kB), 0.23592309953559934, 1e-13);
  EXPECT_NEAR(grey(Beckmann{{0.3, 0.5}, 0.4, 0}, kA, kB), 0.3206939067707974, 1e-13);
  EXPECT_NEAR(albedo(Ggx{{0.3, 0.5}, 1, 0}, at(60, 30)), 0.7451083232299258, 1e-3);
  EXPECT_NEAR(albedo(Beckmann{{0.3, 0.5}, 1, 0}, at(60, 30)), 0.8908478610948384, 1e-3);
}

TEST(CookTorrance, MatchesReferenceValues) {
  EXPECT_NEAR(grey(CookTorrance{0.3, 0.6, 0}, kNormal, kNormal), 0.6 / (4 * kPi * 0.09), 1e-14);
  EXPECT_NEAR(grey(CookTorrance{0.4, 0.04, 0}, kA, kB), 0.031994684225960794, 1e-14);
  EXPECT_NEAR(grey(CookTorrance{0.4, 0.04, 0}, at(75, 0), at(80, 160)), 0.14365748724402036, 1e-13);
  EXPECT_NEAR(albedo(CookTorrance{0.4, 0.04, 0}, at(60, 30)), 0.0692355639029696, 1e-4);
}

TEST(AshikhminShirley, MatchesReferenceValues) {
  const double diffuse_part = 28 * 0.3 * 0.8 / (23 * kPi) * std::pow(31.0 / 32, 2);
  EXPECT_NEAR(grey(AshikhminShirley{8, 24, 0.2, 0.3}, kNormal, kNormal), 15 * 0.2 / (8 * kPi) + diffuse_part,
              1e-14);
  EXPECT_NEAR(grey(AshikhminShirley{10, 40, 0.2, 0.3}, kA, kB), 0.15339382046803923, 1e-14);
  EXPECT_NEAR(albedo(AshikhminShirley{10, 40, 1, 0}, at(60, 30)), 0.6638437086170594, 1e-3);
}

}  // namespace
}  // namespace burnish
