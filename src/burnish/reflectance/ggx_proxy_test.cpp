// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/testing/sampling.h>

namespace burnish {
namespace {

TEST(GgxProxy, DrawsByItsDensity) {
  std::uint64_t seed = 1;
  for (const GgxProxy& proxy : {GgxProxy{{0.3, 0.3}}, GgxProxy{{0.05, 0.4}}, GgxProxy{{0.1, 0.1}, 0.6}})
    for (const Vec3 wo : kViews) {
      const DrawTest test = test_draws(proxy, wo, 50'000, ++seed);
      EXPECT_GT(test.p_value, level_of_each(0.01, 12)) << seed;
      EXPECT_LT(test.integral, 1.002);
    }
}

TEST(GgxProxy, FitFindsTheGgxItIsGiven) {
  const GgxProxy round =
      fit_ggx_proxy(parse_analytic("ggx:alpha_x=0.12,alpha_y=0.12,f0=1,kd=0").ref(), false);
  EXPECT_NEAR(round.distribution.alpha_x, 0.12, 0.02);
  EXPECT_EQ(round.distribution.alpha_x, round.distribution.alpha_y);
  EXPECT_EQ(round.share, 1);
  const GgxProxy brushed =
      fit_ggx_proxy(parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3,f0=1,kd=0.3").ref(), true);
  EXPECT_NEAR(brushed.distribution.alpha_x, 0.1, 0.02);
  EXPECT_NEAR(brushed.distribution.alpha_y, 0.3, 0.06);
  EXPECT_NEAR(brushed.share, 0.75, 0.1);
}

}  // namespace
}  // namespace burnish
