// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/testing/directions.h>

namespace burnish {
namespace {

TEST(HalfDiff, RoundTripsDirections) {
  Pcg32 random(1);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
    const HalfDiff angles = to_half_diff(wi, wo);
    if (angles.theta_d > radians(89.9)) continue;
    const HalfDiffDirections back = from_half_diff(angles);
    EXPECT_LT(length(back.wi - wi), 1e-12);
    EXPECT_LT(length(back.wo - wo), 1e-12);
  }
}

TEST(HalfDiff, RoundTripsAngles) {
  Pcg32 random(2);
  for (int i = 0; i < 10000; ++i) {
    const HalfDiff angles{0.01 + 1.5 * random.uniform(), kTwoPi * random.uniform(),
                          0.01 + 1.5 * random.uniform(), kTwoPi * random.uniform()};
    const HalfDiffDirections directions = from_half_diff(angles);
    const HalfDiff back = to_half_diff(directions.wi, directions.wo);
    EXPECT_NEAR(back.theta_h, angles.theta_h, 1e-11);
    EXPECT_NEAR(std::remainder(back.phi_h - angles.phi_h, kTwoPi), 0, 1e-11);
    EXPECT_NEAR(back.theta_d, angles.theta_d, 1e-11);
    EXPECT_NEAR(std::remainder(back.phi_d - angles.phi_d, kTwoPi), 0, 1e-11);
  }
}

TEST(HalfDiff, ExchangingTheDirectionsTurnsPhiDByPi) {
  Pcg32 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
    const HalfDiff a = to_half_diff(wi, wo), b = to_half_diff(wo, wi);
    EXPECT_DOUBLE_EQ(a.theta_h, b.theta_h);
    EXPECT_DOUBLE_EQ(a.phi_h, b.phi_h);
    EXPECT_DOUBLE_EQ(a.theta_d, b.theta_d);
    EXPECT_NEAR(std::abs(std::remainder(a.phi_d - b.phi_d, kTwoPi)), kPi, 1e-9);
  }
}

TEST(HalfDiff, TurningBothDirectionsChangesPhiHOnly) {
  Pcg32 random(4);
  for (int i = 0; i < 1000; ++i) {
    const double ti = 1.5 * random.uniform(), to = 1.5 * random.uniform();
    const double pi = kTwoPi * random.uniform(), po = kTwoPi * random.uniform(),
                 turn = kTwoPi * random.uniform();
    const HalfDiff a = to_half_diff(spherical_direction(ti, pi), spherical_direction(to, po));
    const HalfDiff b = to_half_diff(spherical_direction(ti, pi + turn), spherical_direction(to, po + turn));
    EXPECT_NEAR(a.theta_h, b.theta_h, 1e-12);
    EXPECT_NEAR(std::remainder(a.phi_h + turn - b.phi_h, kTwoPi), 0, 1e-9);
    EXPECT_NEAR(a.theta_d, b.theta_d, 1e-12);
    EXPECT_NEAR(std::remainder(a.phi_d - b.phi_d, kTwoPi), 0, 1e-9);
  }
}

TEST(HalfDiff, CornersHaveTheirPlainAngles) {
  const Vec3 normal{0, 0, 1};
  HalfDiff angles = to_half_diff(normal, normal);
  EXPECT_EQ(angles.theta_h, 0);
  EXPECT_EQ(angles.theta_d, 0);
  EXPECT_EQ(angles.phi_d, 0);

  const Vec3 w = spherical_direction(1, 2);
  angles = to_half_diff(w, w);
  EXPECT_NEAR(angles.theta_h, 1, 1e-15);
  EXPECT_NEAR(angles.phi_h, 2, 1e-15);
  EXPECT_EQ(angles.theta_d, 0);

  angles = to_half_diff(spherical_direction(1, 0.5), mirror(spherical_direction(1, 0.5)));
  EXPECT_NEAR(angles.theta_h, 0, 1e-15);
  EXPECT_NEAR(angles.theta_d, 1, 1e-15);

  // Both grazing and opposite: the half vector is the normal by convention.
  angles = to_half_diff({1, 0, 0}, {-1, 0, 0});
  EXPECT_EQ(angles.theta_h, 0);
  EXPECT_DOUBLE_EQ(angles.theta_d, kHalfPi);
  EXPECT_EQ(angles.phi_d, 0);
}

TEST(HalfDiff, RoundingHasNoAzimuth) {
  Pcg32 random(4);
  for (int i = 0; i < 1000; ++i) {
    const auto rounded = [&](Vec3 w) { return w + 2e-16 * random_direction(random); };
    const Vec3 w = spherical_direction(1.5 * random.uniform(), kTwoPi * random.uniform());
    EXPECT_EQ(to_half_diff(rounded(w), rounded(w)).phi_d, 0);
    EXPECT_EQ(to_half_diff(rounded(w), rounded(mirror(w))).phi_h, 0);
    EXPECT_EQ(phi_of(rounded({0, 0, 1})), 0);
  }
}

TEST(HalfDiff, KeepsSmallDifferenceAngles) {
  const double tiny = 1e-9;
  const HalfDiffDirections directions = from_half_diff({0.3, 0.4, tiny, 1.2});
  EXPECT_NEAR(to_half_diff(directions.wi, directions.wo).theta_d, tiny, 1e-15);
}

}  // namespace
}  // namespace burnish
