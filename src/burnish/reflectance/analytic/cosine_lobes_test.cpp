// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/reflectance/analytic/cosine_lobes.h>
#include <burnish/testing/albedo.h>
#include <burnish/testing/analytic_values.h>

namespace burnish {
namespace {

using fixtures::at;
using fixtures::grey;
using fixtures::kA;
using fixtures::kB;
using fixtures::kNormal;

TEST(Phong, HasItsPowerAtKnownAngles) {
  // Towards the light from 30 degrees, cos(gamma) = 2 cos² - 1 = 1/2.
  const Phong lobe{.kd = 0, .ks = 1, .exponent = 3, .normalized = false};
  EXPECT_NEAR(grey(lobe, at(30, 40), at(30, 40)), 0.125, 1e-14);
  EXPECT_NEAR(grey(lobe, at(30, 40), at(30, 220)), 1, 1e-14);
  EXPECT_EQ(grey(lobe, at(60, 40), at(60, 40)), 0);
}

TEST(Phong, ReflectsEverythingAtNormalIncidenceWhereNormalized) {
  for (const double exponent : {1.0, 7.5, 100.0})
    EXPECT_NEAR(albedo(Phong{.kd = 0, .ks = 1, .exponent = exponent}, kNormal), 1, 1e-5) << exponent;
}

TEST(BlinnPhong, HasItsPowerAtKnownAngles) {
  const BlinnPhong lobe{.kd = 0, .ks = 1, .exponent = 4, .normalized = false};
  EXPECT_NEAR(grey(lobe, at(60, 40), at(60, 40)), 0.0625, 1e-14);  // h is at 60 degrees
  EXPECT_NEAR(grey(lobe, at(75, 40), at(75, 220)), 1, 1e-14);
}

TEST(BlinnPhong, ReflectsEverythingAtNormalIncidenceWhereNormalized) {
  for (const double exponent : {1.0, 7.5, 100.0})
    EXPECT_NEAR(albedo(BlinnPhong{.kd = 0, .ks = 1, .exponent = exponent}, kNormal), 1, 1e-3) << exponent;
}

TEST(Lafortune, SumsItsLobes) {
  Lafortune brdf{.kd = 0, .lobes = {}};
  brdf.lobes[1] = {.cx = -0.8, .cy = -0.9, .cz = 0.7, .exponent = 4, .ks = 1};
  EXPECT_NEAR(grey(brdf, kA, kB), 0.20197343027903056, 1e-14);
  brdf.lobes[2] = {.cx = 0, .cy = 0, .cz = 1, .exponent = 1, .ks = 2};
  EXPECT_NEAR(grey(brdf, kA, kB), 0.20197343027903056 + 2 * kA.z * kB.z, 1e-14);
}

TEST(Lafortune, IsPhongWithTheCoefficientsOfTheMirror) {
  Lafortune brdf{.kd = 0.1, .lobes = {}};
  brdf.lobes[0] = {.cx = -1, .cy = -1, .cz = 1, .exponent = 12, .ks = 0.5};
  const Phong phong{.kd = 0.1, .ks = 0.5, .exponent = 12, .normalized = false};
  EXPECT_NEAR(grey(brdf, kA, kB), grey(phong, kA, kB), 1e-14);
}

}  // namespace
}  // namespace burnish
