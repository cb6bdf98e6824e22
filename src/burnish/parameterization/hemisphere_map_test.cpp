// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/hemisphere_map.h>

namespace burnish {
namespace {

const Warp kWarps[] = {{},
                       {WarpKind::power, 0.5},
                       {WarpKind::rational, 0.05},
                       {WarpKind::rational, 2},
                       {WarpKind::rational, -1.2}};

TEST(Warp, IsMonotoneOntoTheUnitIntervalAndInvertsItself) {
  for (const Warp& warp : kWarps) {
    EXPECT_EQ(warp.forward(0), 0);
    EXPECT_DOUBLE_EQ(warp.forward(1), 1);
    double last = -1;
    for (int i = 0; i <= 1000; ++i) {
      const double t = i / 1000.0, u = warp.forward(t);
      EXPECT_GT(u, last);
      EXPECT_NEAR(warp.inverse(u), t, 1e-14);
      last = u;
    }
  }
}

TEST(Warp, ReadsWhatItPrints) {
  for (const Warp& warp : kWarps) EXPECT_EQ(parse_warp(to_string(warp)), warp);
}

TEST(Warp, RefusesWhatItDoesNotKnow) {
  for (const char* text : {"", "power", "power:0", "power:1.5", "rational:-1", "rational:-0.5",
                           "rational:nan", "rational:1x", "log"})
    EXPECT_THROW(parse_warp(text), Error) << text;
}

TEST(HemisphereMap, IdentityIsTheParabolicMap) {
  const Vec3 w = spherical_direction(0.7, 1.1);
  const DiskPoint p = to_disk(w, {});
  EXPECT_DOUBLE_EQ(p.x, w.x / (1 + w.z));
  EXPECT_DOUBLE_EQ(p.y, w.y / (1 + w.z));
}

TEST(HemisphereMap, RoundTripsDirections) {
  Pcg32 random(1);
  for (const Warp& warp : kWarps)
    for (int i = 0; i < 2000; ++i) {
      const double theta = i == 0 ? 0 : i == 1 ? kHalfPi : random.uniform() * kHalfPi;
      Vec3 w = spherical_direction(theta, random.uniform() * kTwoPi);
      w.z = std::max(w.z, 0.0);
      const DiskPoint p = to_disk(w, warp);
      EXPECT_LE(std::hypot(p.x, p.y), 1 + 1e-12);
      EXPECT_LT(length(from_disk(p, warp) - w), 1e-12) << to_string(warp) << " theta " << theta;
    }
}

TEST(HemisphereMap, TakesTheCornersToTheHorizon) {
  const Vec3 w = from_disk({1, 1}, {});
  EXPECT_NEAR(w.z, 0, 1e-15);
  EXPECT_NEAR(w.x, std::sqrt(0.5), 1e-15);
}

TEST(HemisphereMap, TangentOfHalfTheAngleIsExactNearTheNormal) {
  for (const double theta : {1e-12, 1e-6, 0.3, 1.5})
    EXPECT_NEAR(tan_half_theta(spherical_direction(theta, 0.4)) / std::tan(theta / 2), 1, 1e-12);
}

}  // namespace
}  // namespace burnish
