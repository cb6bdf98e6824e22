// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/patch_table.h>

namespace burnish {
namespace {

TEST(PatchBasis, CoversTheHemisphere) {
  const std::array<std::pair<PatchBasis, std::size_t>, 4> bases = {{{klems_full_basis(), 145},
                                                                    {klems_half_basis(), 77},
                                                                    {klems_older_half_basis(), 73},
                                                                    {klems_quarter_basis(), 41}}};
  for (const auto& [basis, count] : bases) {
    ASSERT_EQ(basis.size(), count);
    double total = 0;
    for (std::size_t k = 0; k < basis.size(); ++k) total += basis.projected_solid_angle(k);
    EXPECT_NEAR(total, kPi, 1e-12);
  }
}

TEST(PatchBasis, HasEachPatchAtItsCentreAndWithinItsBounds) {
  PatchBasis basis = klems_half_basis();
  basis.first_azimuth = 3;
  for (const PatchRing& ring : basis.rings)
    for (std::size_t k = 0; k < ring.count; ++k) {
      const std::size_t patch = ring.first + k;
      EXPECT_EQ(basis.patch_of(basis.centre(patch)), patch);
      const double step = kTwoPi / static_cast<double>(ring.count);
      for (const double side : {-0.49, 0.49}) {
        const double phi = basis.first_azimuth + step * (static_cast<double>(k) + side);
        for (const double theta : {ring.theta_low + 1e-9, ring.theta_high - 1e-9})
          EXPECT_EQ(basis.patch_of(spherical_direction(theta, phi)), patch);
      }
    }
  for (const Vec3 w : {Vec3{1, 0, 0}, Vec3{0.6, -1e-17, 0.8}, Vec3{0, 0, -1}})
    EXPECT_LT(basis.patch_of(w), basis.size());
}

// Each incident patch sends its light into one outgoing patch: energy shows whatever is wrong with patches.
TEST(PatchTable, ReflectsWhatTheMatrixSaysAtEveryAngle) {
  for (const PatchBasis& basis : {klems_full_basis(), klems_half_basis(), klems_quarter_basis()}) {
    PatchTable mirror{basis, basis, std::vector<float>(basis.size() * basis.size(), 0.0f)};
    for (std::size_t k = 0; k < basis.size(); ++k)
      mirror.values[k * basis.size() + k] = static_cast<float>(0.1 / basis.projected_solid_angle(k));
    for (const double theta : {0.0, 0.3, radians(30), radians(60), radians(80)}) {
      const Vec3 wi = spherical_direction(theta, 0.4);
      // by a grid that every border of patches is a line of: the midpoint rule's own error is left
      double reflected = 0, f = 0;
      constexpr int kThetas = 360, kPhis = 480;
      for (int t = 0; t < kThetas; ++t)
        for (int p = 0; p < kPhis; ++p) {
          const double theta_o = kHalfPi * (t + 0.5) / kThetas, phi = kTwoPi * (p + 0.5) / kPhis;
          ASSERT_TRUE(mirror.eval(wi, spherical_direction(theta_o, phi), {&f, 1}));
          reflected += f * std::sin(theta_o) * std::cos(theta_o) * (kHalfPi / kThetas) * (kTwoPi / kPhis);
        }
      EXPECT_NEAR(mirror.albedo(wi), 0.1, 1e-7);
      EXPECT_NEAR(reflected, 0.1, 1e-5) << basis.size() << " patches, " << degrees(theta) << " degrees";
    }
  }
}

TEST(PatchTable, HasTheValueOfThePairOfPatches) {
  PatchTable table{klems_full_basis(), klems_quarter_basis(), {}};
  table.incident.first_azimuth = 2;
  for (std::size_t k = 0; k < 145 * 41; ++k) table.values.push_back(static_cast<float>(k));
  double f;
  for (const auto& [wi, wo] : draw_pairs(2000, 2, false)) {
    ASSERT_TRUE(table.eval(wi, wo, {&f, 1}));
    EXPECT_EQ(f, static_cast<double>(table.outgoing.patch_of(wo) * 145 + table.incident.patch_of(wi)));
  }
  EXPECT_TRUE(table.eval({0, 0, -1}, {0, 0, 1}, {&f, 1}));
  EXPECT_EQ(f, 0);
}

}  // namespace
}  // namespace burnish
