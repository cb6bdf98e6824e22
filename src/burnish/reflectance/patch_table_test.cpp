#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/patch_table.h>

namespace burnish {
namespace {

TEST(PatchBasis, CoversTheHemisphere) {
  const PatchBasis basis = klems_full_basis();
  ASSERT_EQ(basis.size(), 145u);
  double total = 0;
  for (std::size_t k = 0; k < basis.size(); ++k) total += basis.projected_solid_angle(k);
  EXPECT_NEAR(total, kPi, 1e-12);
}

TEST(PatchBasis, PutsAllWeightOnAPatchAtItsCentre) {
  PatchBasis basis = klems_full_basis();
  basis.first_azimuth = 3;
  for (std::size_t k = 0; k < basis.size(); ++k) {
    const PatchNeighbours near = basis.neighbours(basis.centre(k));
    double weight = 0;
    for (std::size_t i = 0; i < 4; ++i) weight += near.index[i] == k ? near.weight[i] : 0;
    EXPECT_NEAR(weight, 1, 1e-9) << k;
  }
}

TEST(PatchBasis, HasWeightsThatSumToOne) {
  const PatchBasis basis = klems_full_basis();
  for (const auto& [wi, wo] : draw_pairs(2000, 1, false))
    for (const Vec3 w : {wi, wo, Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.6, -1e-17, 0.8}}) {
      const PatchNeighbours near = basis.neighbours(w);
      EXPECT_NEAR(std::accumulate(near.weight.begin(), near.weight.end(), 0.0), 1, 1e-12);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_GE(near.weight[i], 0);
        EXPECT_LT(near.index[i], basis.size());
      }
    }
}

TEST(PatchTable, ApproximatesASmoothAnisotropicFunction) {
  PatchTable table{klems_full_basis(), klems_full_basis(), {}};
  table.incident.first_azimuth = 2;
  const auto g = [](Vec3 wi, Vec3 wo) { return 2 + wi.x * wo.y + wi.z; };
  for (std::size_t o = 0; o < 145; ++o)
    for (std::size_t i = 0; i < 145; ++i)
      table.values.push_back(static_cast<float>(g(table.incident.centre(i), table.outgoing.centre(o))));
  double f;
  for (const auto& [wi, wo] : draw_pairs(2000, 2, false)) {
    ASSERT_TRUE(table.eval(wi, wo, {&f, 1}));
    if (theta_of(wi) < radians(82) && theta_of(wo) < radians(82)) {
      EXPECT_NEAR(f, g(wi, wo), 0.06);
    }
  }
  EXPECT_TRUE(table.eval({0, 0, -1}, {0, 0, 1}, {&f, 1}));
  EXPECT_EQ(f, 0);
}

}  // namespace
}  // namespace burnish
