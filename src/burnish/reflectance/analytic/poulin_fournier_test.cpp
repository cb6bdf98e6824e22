// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/quadrature.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic/cosine_lobes.h>
#include <burnish/reflectance/analytic/poulin_fournier.h>
#include <burnish/testing/analytic_values.h>

namespace burnish {
namespace {

using fixtures::at;
using fixtures::grey;
using fixtures::kA;
using fixtures::kB;
using fixtures::kNormal;

TEST(PoulinFournier, HasItsClosedFormAtNormalIncidence) {
  // Half cylinders: the integral of cos² over the arc is pi/2, the floor between them spacing - 2.
  const PoulinFournier diffuse_cylinders{.spacing = 3, .height = 1, .kd = 0.5, .ks = 0};
  EXPECT_NEAR(grey(diffuse_cylinders, kNormal, kNormal), 0.5 / kPi * (kHalfPi + 1) / 3, 1e-14);
}

TEST(PoulinFournier, MatchesRaysTracedThroughTheCylinders) {
  const auto diffuse_only = [](double spacing, double height, Vec3 wi, Vec3 wo) {
    return grey(PoulinFournier{spacing, height, 50, 1, 0}, wi, wo);
  };
  const auto specular_only = [](double spacing, double height, double exponent, Vec3 wi, Vec3 wo) {
    return grey(PoulinFournier{spacing, height, exponent, 0, 1}, wi, wo);
  };
  EXPECT_NEAR(diffuse_only(2.5, 1, kA, kB), 0.2634911277552571, 1e-8);
  EXPECT_NEAR(specular_only(2.5, 1, 50, kA, kB), 0.31920134233708136, 1e-5);
  EXPECT_NEAR(diffuse_only(3, 0.4, kA, kB), 0.3002153874509721, 1e-8);
  EXPECT_NEAR(specular_only(3, 0.4, 200, kA, kB), 0.18286524405626386, 1e-5);
  EXPECT_NEAR(diffuse_only(2.2, 0.9, at(70, 60), at(65, 250)), 0.08223099673920896, 1e-8);
  EXPECT_NEAR(specular_only(2.2, 0.9, 20, at(70, 60), at(65, 250)), 0.12666610241220655, 1e-5);
}

TEST(PoulinFournier, ShowsEveryDirectionExactlyOneGroundArea) {
  Pcg32 random(7);
  for (int i = 0; i < 500; ++i) {
    const PoulinFournier brdf{.spacing = 2 + 3 * random.uniform(), .height = 0.01 + 0.99 * random.uniform()};
    const Vec3 w = spherical_direction(kHalfPi * random.uniform(), kTwoPi * random.uniform());
    const auto arc = brdf.visible_arc(w);
    const auto floor = brdf.visible_floor(w);
    const double cylinders =
        integrate<12>(arc.lo, arc.hi, [&](double psi) { return w.y * std::sin(psi) + w.z * std::cos(psi); });
    EXPECT_NEAR(cylinders + std::max(0.0, floor.hi - floor.lo) * w.z, brdf.spacing * w.z, 1e-12);
  }
}

TEST(PoulinFournier, IntegratesItsHighlightAccurately) {
  Pcg32 random(8);
  for (const double exponent : {1.0, 30.0, 1000.0, 10000.0})
    for (int i = 0; i < 20; ++i) {
      const PoulinFournier brdf{.spacing = 100, .height = 1, .exponent = exponent, .kd = 0, .ks = 1};
      // Far apart, lit from within 40 degrees of the normal: the arc is limited by facing alone.
      const Vec3 wi = spherical_direction(0.7 * random.uniform(), kTwoPi * random.uniform());
      const Vec3 wo = spherical_direction(0.7 * random.uniform(), kTwoPi * random.uniform());
      const Vec3 h = half_vector(wi, wo);
      const auto arc_i = brdf.visible_arc(wi), arc_o = brdf.visible_arc(wo);
      const double lo = std::max(arc_i.lo, arc_o.lo), hi = std::min(arc_i.hi, arc_o.hi);
      double sum = 0;
      constexpr int kSteps = 4000;
      for (int k = 0; k < kSteps; ++k) {
        const double psi = lo + (hi - lo) * (k + 0.5) / kSteps, y = std::sin(psi), z = std::cos(psi);
        sum += std::pow(std::max(0.0, h.y * y + h.z * z), exponent) * (wi.y * y + wi.z * z) *
               (wo.y * y + wo.z * z);
      }
      const double cylinder = sum * (hi - lo) / kSteps / (100 * wi.z * wo.z);
      const auto floor_i = brdf.visible_floor(wi), floor_o = brdf.visible_floor(wo);
      const double floor = (std::min(floor_i.hi, floor_o.hi) - std::max(floor_i.lo, floor_o.lo)) / 100;
      const double expected =
          blinn_phong_normalization(exponent) * (cylinder + floor * std::pow(h.z, exponent));
      EXPECT_NEAR(grey(brdf, wi, wo), expected, 1e-4 * expected) << exponent;
    }
}

}  // namespace
}  // namespace burnish
