// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/metrics/albedo.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/patch_means.h>

namespace burnish {
namespace {

PatchBasis from_opposite(PatchBasis basis) {
  basis.first_azimuth = kPi;
  return basis;
}

TEST(PatchMeans, GiveATableOfTheSameBasesBack) {
  PatchTable table{
      .incident = from_opposite(klems_quarter_basis()), .outgoing = klems_quarter_basis(), .values = {}};
  for (std::size_t k = 0; k < 41 * 41; ++k) table.values.push_back(static_cast<float>(k % 17) * 0.01f);
  const PatchTable means = patch_means(table, table.incident, table.outgoing);
  ASSERT_EQ(means.values.size(), table.values.size());
  for (std::size_t k = 0; k < means.values.size(); ++k)
    ASSERT_NEAR(means.values[k], table.values[k], 1e-6) << k;
}

TEST(PatchMeans, KeepTheEnergyOfAHighlight) {
  // The highlight is half as wide as a patch. Nodes would catch it or miss it.
  const AnalyticBrdf glossy = parse_analytic("ggx:alpha_x=0.12,alpha_y=0.12,f0=1");
  const PatchTable table = patch_means(glossy.ref(), from_opposite(klems_full_basis()), klems_full_basis());
  for (const std::size_t patch : {0u, 4u, 30u, 60u}) {
    const Vec3 wi = table.incident.centre(patch);
    const double albedo = directional_albedo(glossy.ref(), wi).albedo[0];
    EXPECT_NEAR(table.albedo(wi), albedo, 0.02 * albedo) << patch;
  }
}

}  // namespace
}  // namespace burnish
