// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/direct_share.h>
#include <burnish/reflectance/function_brdf.h>
#include <burnish/reflectance/patch_means.h>

namespace burnish {
namespace {

/// Returns patches of the full basis with one value everywhere, and a share more in each mirror patch.
PatchTable patches(double value, double direct) {
  PatchTable table{.incident = klems_full_basis(), .outgoing = klems_full_basis(), .values = {}};
  table.incident.first_azimuth = kPi;
  const std::size_t n = table.outgoing.size();
  table.values.assign(n * n, static_cast<float>(value));
  for (std::size_t k = 0; k < n; ++k)
    table.values[k * n + k] += static_cast<float>(direct / table.outgoing.projected_solid_angle(k));
  return table;
}

TEST(DirectShare, IsTheExcessOfTheMirrorPatch) {
  const PatchTable table = patches(0.1 / kPi, 0.06);
  for (const double theta : {0.0, 0.2, 0.7, 1.2, 1.5}) {
    const LightShares shares = light_shares(table, spherical_direction(theta, 0.4));
    EXPECT_NEAR(shares.direct, 0.06, 1e-6) << theta;
    EXPECT_NEAR(shares.scattered, 0.1, 1e-6) << theta;
  }
}

TEST(DirectShare, IsNothingOfBroadLight) {
  EXPECT_EQ(light_shares(patches(0.2, 0), {0, 0, 1}).direct, 0);
  // One patch of the whole hemisphere is not narrow.
  PatchTable whole;
  whole.incident.rings = whole.outgoing.rings = {{0, kHalfPi, 1, 0}};
  whole.values = {0.2f};
  EXPECT_EQ(light_shares(whole, {0, 0, 1}).direct, 0);
  EXPECT_NEAR(light_shares(whole, {0, 0, 1}).scattered, 0.2 * kPi, 1e-6);
  // A lobe of tens of degrees is wider than a patch.
  const AnalyticBrdf broad = parse_analytic("ggx:alpha_x=0.5,alpha_y=0.5");
  PatchBasis incident = klems_full_basis();
  incident.first_azimuth = kPi;
  const PatchTable table = patch_means(broad.ref(), incident, klems_full_basis());
  for (const double theta : {0.0, 0.5})
    EXPECT_EQ(light_shares(table, spherical_direction(theta, 0)).direct, 0);
}

TEST(DirectShare, SumsTreesExactly) {
  const FunctionBrdf lambert(1, true, [](std::span<const DirectionPair>, std::span<double> values) {
    std::ranges::fill(values, 0.4 / kPi);
  });
  const TensorTree tree = tabulate_tree(lambert, 2, 1e-3);
  const LightShares shares = light_shares(tree, spherical_direction(0.5, 1));
  EXPECT_EQ(shares.direct, 0);
  EXPECT_NEAR(shares.scattered, 0.4, 1e-6);
}

TEST(DirectShare, SeesANarrowCube) {
  // The outgoing cell in the mirror direction is bright. The others of 32 x 32 lie farther off.
  constexpr double kBright = 10, kDark = 0.05, kCell = kPi / 1024;
  const auto narrow = [](std::span<const DirectionPair> pairs, std::span<double> values) {
    for (std::size_t k = 0; k < pairs.size(); ++k)
      values[k] = angle_between(mirror(pairs[k].wi), pairs[k].wo) < radians(1) ? kBright : kDark;
  };
  const FunctionBrdf function(1, true, narrow);
  const LightShares shares = light_shares(tabulate_tree(function, 5, 1e-3), {0, 0, 1});
  EXPECT_NEAR(shares.direct + shares.scattered, kPi * kDark + kCell * (kBright - kDark), 1e-4);
  EXPECT_NEAR(shares.direct, kCell * (kBright - kDark), 0.3 * kCell * kBright);
}

}  // namespace
}  // namespace burnish
