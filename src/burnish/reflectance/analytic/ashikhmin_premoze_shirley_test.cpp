// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic/ashikhmin_premoze_shirley.h>
#include <burnish/testing/analytic_values.h>

namespace burnish {
namespace {

using fixtures::at;
using fixtures::grey;
using fixtures::kA;
using fixtures::kB;
using fixtures::kNormal;

TEST(ProjectedAreaTable, MatchesTheClosedFormOfGaussianSlopes) {
  Pcg32 random(9);
  const struct {
    BeckmannDistribution distribution;
    double bound;
  } kCases[] = {
      {{1, 1}, 2e-4}, {{0.3, 0.5}, 2e-4}, {{0.1, 0.1}, 3e-3}, {{0.05, 0.05}, 3e-3}, {{0.05, 0.5}, 3e-3}};
  for (const auto& [distribution, bound] : kCases) {
    // Three times the density must give the same table.
    const ProjectedAreaTable table([&d = distribution](Vec3 h) { return 3 * d.density(h); },
                                   distribution.isotropic());
    EXPECT_NEAR(table.density_scale(), 1.0 / 3, 1e-3);
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
      const double r = random.uniform();
      const Vec3 w = spherical_direction(kHalfPi * (1 - r * r), kTwoPi * random.uniform());
      worst = std::max(worst, std::abs(table(w) / distribution.projected_area(w) - 1));
    }
    EXPECT_LT(worst, bound) << distribution.alpha_x << ", " << distribution.alpha_y;
  }
}

TEST(ProjectedAreaTable, RefusesWhatIsNoDensity) {
  EXPECT_THROW(ProjectedAreaTable([](Vec3) { return 0.0; }, true), Error);
  EXPECT_THROW(ProjectedAreaTable([](Vec3 h) { return h.x; }, false), Error);
  EXPECT_THROW(ProjectedAreaTable([](Vec3) { return std::numeric_limits<double>::infinity(); }, true), Error);
}

TEST(AshikhminPremozeShirley, IsDensityOverFourProjectedAreas) {
  const CrossedGaussians threads{0.2, 0.5, 0.3};
  const Satin satin(threads, 1, 0, 0);
  const auto area = [&](Vec3 w) {
    return 0.7 * BeckmannDistribution{0.2, 0.5}.projected_area(w) +
           0.3 * BeckmannDistribution{0.5, 0.2}.projected_area(w);
  };
  const double expected = threads.density(half_vector(kA, kB)) / (4 * area(kA) * area(kB));
  EXPECT_NEAR(grey(satin, kA, kB), expected, 2e-3 * expected);
  // All facets are alike where two Gaussians of one width cross.
  EXPECT_NEAR(grey(Satin({0.3, 0.3, 0.5}, 0.4, 0.1, 0), kNormal, kNormal), 0.4 / (4 * kPi * 0.09) + 0.1 / kPi,
              1e-3);
}

TEST(AshikhminPremozeShirley, TakesAnyDistribution) {
  // Facets of a sphere: every normal as often, sigma(w) = (1 + w.z) / 2 and density 1 / pi.
  struct Sphere {
    double density(Vec3) const noexcept { return 5; }
    bool isotropic() const noexcept { return true; }
  };
  const AshikhminPremozeShirley<Sphere> brdf({}, 1, 0, 0);
  EXPECT_NEAR(grey(brdf, kA, kB), 1 / (kPi * (1 + kA.z) * (1 + kB.z)), 1e-4);
}

TEST(AshikhminPremozeShirley, MasksLessWhereDirectionsShareAnAzimuth) {
  const CrossedGaussians threads{0.5, 0.5, 0};
  const Satin apart(threads, 1, 0, 0), together(threads, 1, 0, 0.35);
  EXPECT_GT(grey(together, at(80, 10), at(75, 10)), 1.1 * grey(apart, at(80, 10), at(75, 10)));
  EXPECT_NEAR(grey(together, at(80, 10), at(75, 190)), grey(apart, at(80, 10), at(75, 190)), 1e-12);
}

}  // namespace
}  // namespace burnish
