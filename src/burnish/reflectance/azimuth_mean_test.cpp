// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/reflectance/azimuth_mean.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

// 1 + cos(2 phi_i) in one channel, known on the right half only where `half`.
struct Brushed {
  bool half = false;

  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return false; }
  bool eval(Vec3 wi, Vec3, std::span<double> f) const noexcept {
    const double phi = phi_of(wi);
    f[0] = half && std::cos(phi) < 0 ? 0 : 1 + std::cos(2 * phi);
    return !half || std::cos(phi) >= 0;
  }
};

TEST(AzimuthMean, AveragesAnisotropyAway) {
  const Brushed brushed;
  const AzimuthMean mean(brushed);
  EXPECT_TRUE(mean.isotropic());
  for (const auto& [wi, wo] : draw_pairs(50, 1, false)) {
    double f;
    ASSERT_TRUE(mean.eval(wi, wo, {&f, 1}));
    EXPECT_NEAR(f, 1, 1e-12);
  }
}

TEST(AzimuthMean, ExchangesDirectionsAtEverySecondRotation) {
  // f(wi, wo) = (1 + cos(2 phi_i)) cos(theta_i): no harmonic is left in either half of the rotations
  struct OneWay {
    std::size_t channels() const noexcept { return 1; }
    bool isotropic() const noexcept { return false; }
    bool eval(Vec3 wi, Vec3, std::span<double> f) const noexcept {
      f[0] = (1 + std::cos(2 * phi_of(wi))) * wi.z;
      return true;
    }
  };
  const OneWay one_way;
  const AzimuthMean mean(one_way, true);
  for (const auto& [wi, wo] : draw_pairs(50, 1, false)) {
    double f;
    ASSERT_TRUE(mean.eval(wi, wo, {&f, 1}));
    EXPECT_NEAR(f, (wi.z + wo.z) / 2, 1e-12);
  }
}

TEST(AzimuthMean, LeavesUnknownRotationsOut) {
  const Brushed brushed{.half = true};
  const AzimuthMean mean(brushed);
  double f;
  ASSERT_TRUE(mean.eval(spherical_direction(0.5, 0.3), {0, 0, 1}, {&f, 1}));
  EXPECT_NEAR(f, 1, 0.1);
}

TEST(AzimuthMean, LeavesIsotropicSourcesAsTheyAre) {
  const fixtures::Glossy glossy;
  const AzimuthMean mean(glossy);
  for (const auto& [wi, wo] : draw_pairs(50, 1, false)) {
    std::array<double, 3> f, expected;
    EXPECT_EQ(mean.eval(wi, wo, f), glossy.eval(wi, wo, expected));
    EXPECT_EQ(f, expected);
  }
}

}  // namespace
}  // namespace burnish
