// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/power/cosine.h>
#include <burnish/testing/directions.h>

namespace burnish {
namespace {

TEST(PowerCosine, PhongIsTheCosineToTheMirroredLight) {
  Pcg32 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wi = random_direction(random), wo = random_direction(random);
    EXPECT_NEAR(phong_cosine(wi, wo, {0, 0, 1}), dot(mirror(wi), wo), 1e-14);
    // The same in any frame: turn everything so that x becomes the normal.
    const auto turn = [](Vec3 w) { return Vec3{w.z, w.x, w.y}; };
    EXPECT_NEAR(phong_cosine(turn(wi), turn(wo), {1, 0, 0}), phong_cosine(wi, wo, {0, 0, 1}), 1e-14);
  }
}

TEST(PowerCosine, BlinnIsTheCosineToTheHalfVector) {
  Pcg32 random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wi = random_direction(random), wo = random_direction(random), n = random_direction(random);
    EXPECT_NEAR(blinn_cosine(wi, wo, n), dot(n, half_vector(wi, wo)), 1e-14);
    EXPECT_EQ(blinn_cosine(wi, wo, n), blinn_cosine(wo, wi, n));
  }
}

TEST(PowerCosine, BothAreOneAtTheMirrorDirection) {
  for (double theta : {0.0, 0.3, 1.2, 1.5707}) {
    const Vec3 wi = spherical_direction(theta, 0.7), n{0, 0, 1};
    EXPECT_NEAR(phong_cosine(wi, mirror(wi), n), 1, 1e-15);
    EXPECT_NEAR(blinn_cosine(wi, mirror(wi), n), 1, 1e-15);
  }
  EXPECT_EQ(blinn_cosine({1, 0, 0}, {-1, 0, 0}, {0, 0, 1}), 1);  // grazing, from both sides
}

TEST(PowerCosine, SquaredChordIsTwoMinusTwoCosines) {
  Pcg32 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a = random_direction(random), b = random_direction(random);
    EXPECT_NEAR(chord_squared(a, b), 2 - 2 * dot(a, b), 1e-14);
  }
}

TEST(PowerCosine, TaylorNormalizationErrsByTheCubeOfTheSquaredLengthsDeviation) {
  Pcg32 random(4);
  for (int i = 0; i < 2000; ++i) {
    const double q = 0.7 + 0.6 * random.uniform();
    const Vec3 n = std::sqrt(q) * random_direction(random);
    const Vec3 unit = taylor_normalize(n);
    const double deviation = std::abs(q - 1);
    EXPECT_NEAR(length(unit), 1, (5.0 / 16 + 0.3 * deviation) * deviation * deviation * deviation + 1e-15);
    EXPECT_NEAR(length(cross(unit, n)), 0, 1e-15);
    if (q <= 1) {
      EXPECT_LE(length(unit), 1 + 1e-15);
    }
  }
  EXPECT_EQ(taylor_normalize({0, 0, 1}), (Vec3{0, 0, 1}));
  EXPECT_NEAR(1 - length(taylor_normalize({0, 0, std::sqrt(0.8)})), 2.5e-3, 6e-4);
}

}  // namespace
}  // namespace burnish
