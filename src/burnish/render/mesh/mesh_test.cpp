// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/render/mesh/mesh.h>
#include <burnish/testing/directions.h>

namespace burnish {
namespace {

constexpr double kRounding = 1e-12;

TEST(Bounds, AreTheSmallestBox) {
  MeshPart a, b;
  a.mesh.vertices = {{.position = {1, 2, 3}}, {.position = {-1, 5, 0}}};
  b.mesh.vertices = {{.position = {0, -2, 4}}};
  const std::array parts{a, b};
  const Bounds bounds = bounds_of(parts);
  EXPECT_EQ(bounds.low, (Vec3{-1, -2, 0}));
  EXPECT_EQ(bounds.high, (Vec3{1, 5, 4}));
  EXPECT_EQ(bounds.middle(), (Vec3{0, 1.5, 2}));
  EXPECT_THROW(bounds_of({}), Error);
}

TEST(Tangents, AreUnitAndOrthogonalWhateverIsGiven) {
  Pcg32 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = random_direction(random), w = random_direction(random);
    for (const Vec3& given : {w, n, -n, Vec3{}, 1e-300 * w, 1e8 * w}) {
      const Vec3 t = orthogonalized(given, n);
      EXPECT_NEAR(length(t), 1, kRounding);
      EXPECT_NEAR(dot(t, n), 0, 1e-8);
    }
    const Vec3 around = tangent_around_y(n);
    EXPECT_NEAR(length(around), 1, kRounding);
    EXPECT_NEAR(around.y, 0, kRounding) << "it runs around the vertical axis";
    EXPECT_NEAR(dot(around, n), 0, kRounding);
  }
  for (const Vec3& pole : {Vec3{0, 1, 0}, Vec3{0, -1, 0}})
    EXPECT_NEAR(length(tangent_around_y(pole)), 1, kRounding);
}

}  // namespace
}  // namespace burnish
