// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/reflectance/analytic/fresnel.h>

namespace burnish {
namespace {

TEST(Fresnel, MatchesTheDielectricOfIndexThreeHalves) {
  EXPECT_NEAR(fresnel_dielectric(0.04, 1), 0.04, 1e-15);
  // At 60 degrees: r_s = (1/2 - sqrt(3/2)) / (1/2 + sqrt(3/2)), r_p = (9/8 - sqrt(3/2)) / (9/8 + sqrt(3/2)).
  const double t = std::sqrt(1.5), rs = (0.5 - t) / (0.5 + t), rp = (1.125 - t) / (1.125 + t);
  EXPECT_NEAR(fresnel_dielectric(0.04, 0.5), 0.5 * (rs * rs + rp * rp), 1e-14);
  EXPECT_NEAR(fresnel_dielectric(0.04, kMinCosine), 1, 1e-9);
  EXPECT_EQ(fresnel_dielectric(1.0, 0.3), 1);
  EXPECT_NEAR(fresnel_dielectric(0.0, 0.3), 0, 1e-30);
}

TEST(Fresnel, OfSchlickHasItsEndsExact) {
  EXPECT_EQ(fresnel_schlick(0.3, 1), Rgb(0.3));
  EXPECT_EQ(fresnel_schlick(0.3, 0), Rgb(1));
}

}  // namespace
}  // namespace burnish
