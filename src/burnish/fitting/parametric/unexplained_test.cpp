// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/gaps.h>

namespace burnish {
namespace {

using fixtures::Gaps;

TEST(Unexplained, IsNothingOfTheSameAndSomethingOfWhatReturnsLight) {
  const AnalyticBrdf matt = parse_analytic("lambert:kd=0.3"),
                     back = parse_analytic("lafortune:kd=0.3,cx=0.9,cy=0.9,cz=0.9,exponent=20,ks=1"),
                     red = parse_analytic("lambert:kd=0.3/0.1/0.1");
  const Unexplained same = unexplained(matt.ref(), matt.ref());
  EXPECT_EQ(same.backscatter, 1);
  EXPECT_EQ(same.rings, 1);
  EXPECT_EQ(same.colour_shift, 0);
  EXPECT_EQ(same.grain, 1);
  const AnalyticBrdf along = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.1"),
                     across = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3");
  EXPECT_GT(unexplained(across.ref(), along.ref()).grain.value(), 4);
  EXPECT_NEAR(unexplained(along.ref(), across.ref()).grain.value() *
                  unexplained(across.ref(), along.ref()).grain.value(),
              1, 1e-9);
  EXPECT_GT(unexplained(back.ref(), matt.ref()).backscatter.value(), 1.2);
  EXPECT_GT(unexplained(red.ref(), matt.ref()).colour_shift.value(), 0.2);
}

TEST(Unexplained, SeesARing) {
  // brighter away from theta_h = 0
  const AnalyticBrdf ring = parse_analytic("lafortune:kd=0.1,cx=1.2,cy=1.2,cz=0.3,exponent=8,ks=1"),
                     matt = parse_analytic("lambert:kd=0.1");
  EXPECT_GT(unexplained(ring.ref(), matt.ref()).rings.value(), 1.5);
}

void expect_nothing_unexplained(const Unexplained& found) {
  EXPECT_NEAR(found.backscatter.value(), 1, 1e-12);
  EXPECT_NEAR(found.rings.value(), 1, 1e-12);
  EXPECT_NEAR(found.colour_shift.value(), 0, 1e-12);
}

TEST(Unexplained, LeavesOutWhatIsNotKnown) {
  const AnalyticBrdf even = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.3/0.1/0.1"),
                     brushed = parse_analytic("ggx:alpha_x=0.5,alpha_y=0.2,kd=0.3/0.1/0.1");
  // wi near wo below 50 degrees, and a hole in every series of theta_h
  const Gaps with_holes{even.ref(), [](Vec3 wi, Vec3 wo) {
                          return (angle_between(wi, wo) < radians(5) && theta_of(wi) < radians(50)) ||
                                 std::abs(theta_of(half_vector(wi, wo)) - radians(20)) < radians(3);
                        }};
  expect_nothing_unexplained(unexplained(with_holes, even.ref()));
  // one of four azimuths
  const Gaps with_a_side{brushed.ref(), [](Vec3 wi, Vec3 wo) { return (wi + wo).x < -1e-9; }};
  expect_nothing_unexplained(unexplained(with_a_side, brushed.ref()));
}

TEST(Unexplained, SaysNothingOfWhatIsNotKnownAtAll) {
  const AnalyticBrdf matt = parse_analytic("lambert:kd=0.3");
  const Gaps no_retro{matt.ref(), [](Vec3 wi, Vec3 wo) { return angle_between(wi, wo) < radians(10); }};
  const Unexplained found = unexplained(no_retro, matt.ref());
  EXPECT_FALSE(found.backscatter);
  EXPECT_TRUE(found.rings);
  EXPECT_TRUE(found.colour_shift);
  const Gaps nothing{matt.ref(), [](Vec3, Vec3) { return true; }};
  EXPECT_FALSE(unexplained(nothing, matt.ref()).rings);
  EXPECT_FALSE(unexplained(nothing, matt.ref()).colour_shift);
}

}  // namespace
}  // namespace burnish
