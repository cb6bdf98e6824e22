// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/metrics/albedo.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/analytic/microfacet.h>
#include <burnish/testing/albedo.h>

namespace burnish {
namespace {

/// 0.5 / pi and 1 / pi, known only where wo.x > 0 if `half`.
struct Diffuse {
  bool half = false;

  std::size_t channels() const noexcept { return 2; }
  bool isotropic() const noexcept { return !half; }
  bool eval(Vec3, Vec3 wo, std::span<double> f) const noexcept {
    const bool known = !half || wo.x > 0;
    f[0] = known ? 0.5 / kPi : 0;
    f[1] = 2 * f[0];
    return known;
  }
};

/// (exponent + 1) / (2 pi) cos^exponent of the angle to the mirror direction, over cos(theta_o): albedo 1 at
/// normal incidence.
struct MirrorLobe {
  double exponent;

  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    f[0] = (exponent + 1) / kTwoPi * std::pow(std::max(0.0, dot(mirror(wi), wo)), exponent) / wo.z;
    return true;
  }
};

TEST(DirectionalAlbedo, OfALambertianSurfaceIsItsReflectance) {
  for (const double theta_deg : {0.0, 30.0, 60.0, 85.0, 89.5}) {
    const auto [albedo, clamped, unknown] =
        directional_albedo(Diffuse{}, spherical_direction(radians(theta_deg), 1));
    EXPECT_NEAR(albedo[0], 0.5, 0.5 * kAlbedoTolerance);
    EXPECT_NEAR(albedo[1], 1, kAlbedoTolerance);
    EXPECT_EQ(unknown, 0);
    EXPECT_EQ(clamped, albedo);  // nothing is below zero
  }
}

TEST(DirectionalAlbedo, MeetsNarrowLobes) {
  for (const double exponent : {1.0, 30.0, 1000.0, 1e5})
    EXPECT_NEAR(directional_albedo(MirrorLobe{exponent}, {0, 0, 1}).albedo[0], 1, kAlbedoTolerance)
        << exponent;
}

TEST(DirectionalAlbedo, AgreesWithIntegrationOverTheHalfVector) {
  for (const char* spec :
       {"ggx:alpha_x=0.02,alpha_y=0.02", "ggx:alpha_x=0.4,alpha_y=0.4", "ggx:alpha_x=0.05,alpha_y=0.3"}) {
    const auto brdf = parse_analytic(spec);
    for (const double theta_deg : {0.0, 45.0, 75.0, 85.0}) {
      const Vec3 wi = spherical_direction(radians(theta_deg), 0.4);
      const double expected = over_hemisphere<96, 256>([&](Vec3 h) {
        const double cosine = dot(wi, h);
        const Vec3 wo = 2 * cosine * h - wi;
        if (cosine <= 0 || wo.z <= 0) return 0.0;
        std::array<double, 3> f;
        brdf.ref().eval(wi, wo, f);
        return f[0] * wo.z * 4 * cosine;
      });
      EXPECT_NEAR(directional_albedo(brdf.ref(), wi).albedo[0], expected, kAlbedoTolerance * expected)
          << spec << " at " << theta_deg;
    }
  }
}

TEST(DirectionalAlbedo, CountsTheUnknownShareOfTheHemisphere) {
  const auto [albedo, clamped, unknown] = directional_albedo(Diffuse{true}, spherical_direction(0.3, 1));
  EXPECT_NEAR(unknown, 0.5, 0.01);
  EXPECT_NEAR(albedo[1], 0.5, 0.01);
  EXPECT_NEAR(clamped[1], 0.5, 0.01);
}

TEST(AlbedoCurve, TurnsToTheOtherAxisWhereTheSourceIsAnisotropic) {
  const std::array angles{0.2, 0.4};
  EXPECT_EQ(albedo_curve(Diffuse{}, angles).size(), 2u);
  const std::vector<AlbedoAt> curve = albedo_curve(Diffuse{true}, angles);
  ASSERT_EQ(curve.size(), 4u);
  EXPECT_EQ(curve[3].theta_i, 0.4);
  EXPECT_EQ(curve[3].phi_i, kHalfPi);
}

}  // namespace
}  // namespace burnish
