// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/reflectance/analytic/microfacet_distribution.h>
#include <burnish/testing/albedo.h>
#include <burnish/testing/analytic_values.h>

namespace burnish {
namespace {

using fixtures::at;
using fixtures::kA;
using fixtures::kB;
using fixtures::kNormal;

template <MicrofacetDistribution T>
void expect_normalized(const T& distribution, double tolerance) {
  EXPECT_NEAR(over_hemisphere([&](Vec3 h) { return distribution.density(h) * h.z; }), 1, tolerance);
}

TEST(MicrofacetDistributions, IntegrateToOneOverProjectedSolidAngle) {
  expect_normalized(BeckmannDistribution{0.3, 0.5}, 1e-6);
  expect_normalized(BeckmannDistribution{1, 0.2}, 1e-6);
  expect_normalized(GgxDistribution{0.3, 0.5}, 1e-6);
  expect_normalized(GgxDistribution{1, 0.2}, 1e-6);
  expect_normalized(CrossedGaussians{0.2, 0.5, 0.3}, 1e-6);
}

template <MicrofacetDistribution T>
void expect_projected_area(const T& distribution) {
  for (const Vec3 w : {kNormal, kA, kB, at(80, 90), at(89, 10)}) {
    const double area =
        over_hemisphere([&](Vec3 h) { return distribution.density(h) * std::max(0.0, dot(w, h)); });
    EXPECT_NEAR(distribution.projected_area(w), area, 1e-3 * area) << w.z;
  }
}

TEST(MicrofacetDistributions, HaveTheProjectedAreaOfTheirFacets) {
  expect_projected_area(BeckmannDistribution{0.3, 0.5});
  expect_projected_area(GgxDistribution{0.3, 0.5});
}

}  // namespace
}  // namespace burnish
