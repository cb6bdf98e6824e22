#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/statistics.h>

namespace burnish {
namespace {

/// c / pi, known only where wo.x > 0 if `half`.
struct Diffuse {
  bool half = false;

  int channels() const noexcept { return 2; }
  bool isotropic() const noexcept { return false; }
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

  int channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    f[0] = (exponent + 1) / kTwoPi * std::pow(std::max(0.0, dot(mirror(wi), wo)), exponent) / wo.z;
    return true;
  }
};

struct Skewed {
  int channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    f[0] = wi.z > wo.z ? 3 : 1;
    return true;
  }
};

TEST(DirectionalAlbedo, OfALambertianSurfaceIsItsReflectance) {
  for (const double theta : {0.0, 0.5, 1.5}) {
    const auto [albedo, unknown] = directional_albedo(Diffuse{}, spherical_direction(theta, 1));
    EXPECT_NEAR(albedo[0], 0.5, 0.001);
    EXPECT_NEAR(albedo[1], 1, 0.002);
    EXPECT_EQ(unknown, 0);
  }
}

TEST(DirectionalAlbedo, MeetsNarrowLobes) {
  for (const double exponent : {1.0, 30.0, 1000.0})
    EXPECT_NEAR(directional_albedo(MirrorLobe{exponent}, {0, 0, 1}).albedo[0], 1, 0.002) << exponent;
}

TEST(DirectionalAlbedo, CountsTheUnknownShareOfTheHemisphere) {
  const auto [albedo, unknown] = directional_albedo(Diffuse{true}, spherical_direction(0.3, 1));
  EXPECT_NEAR(unknown, 0.5, 0.01);
  EXPECT_NEAR(albedo[1], 0.5, 0.01);
}

TEST(ReciprocityError, IsTheMeanRelativeAsymmetry) {
  EXPECT_EQ(reciprocity_error(Diffuse{}, 500, 1).mean, 0);
  EXPECT_EQ(reciprocity_error(Diffuse{}, 500, 1).pairs, 500u);
  EXPECT_NEAR(reciprocity_error(Skewed{}, 500, 1).mean, 1, 1e-12);
  const auto half = reciprocity_error(Diffuse{true}, 500, 1);
  EXPECT_LT(half.pairs, 300u);
}

}  // namespace
}  // namespace burnish
