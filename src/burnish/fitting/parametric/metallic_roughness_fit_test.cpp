// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/fitting/parametric/metallic_roughness_fit.h>
#include <burnish/reflectance/analytic.h>

namespace burnish {
namespace {

TEST(MetallicRoughness, AsAMetalIsTheAnalyticGgx) {
  const MetallicRoughness metal{{0.9, 0.6, 0.3}, 1, std::sqrt(0.2), std::sqrt((0.36 - 0.2) / 0.8), true};
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.36,f0=0.9/0.6/0.3");
  for (const Vec3 wi : {Vec3{0, 0, 1}, normalize({0.5, 0.2, 0.4}), normalize({-1, 0.3, 0.05})})
    for (const Vec3 wo : {Vec3{0, 0, 1}, normalize({-0.5, 0.3, 0.8}), normalize({1, 1, 0.1})}) {
      double f[3], expected[3];
      metal.eval(wi, wo, f);
      ggx.eval(wi, wo, expected);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(f[c], expected[c], 1e-9 * expected[c]);
    }
}

TEST(MetallicRoughnessFit, RecoversItsOwnMaterials) {
  for (const MetallicRoughness& truth :
       {MetallicRoughness{{0.9, 0.5, 0.25}, 1, 0.4}, MetallicRoughness{{0.1, 0.3, 0.6}, 0, 0.5}}) {
    const MetallicRoughnessFit fit = fit_metallic_roughness(truth);
    EXPECT_GE(fit.psnr, 42);
    EXPECT_NEAR(fit.material.metallic, truth.metallic, 0.1);
    EXPECT_NEAR(fit.material.roughness, truth.roughness, 0.03);
    EXPECT_NEAR(fit.material.base_color.r, truth.base_color.r, 0.1);  // highlights are white
    EXPECT_EQ(fit.material.anisotropy, 0);
  }
}

TEST(MetallicRoughnessFit, FindsTheDirectionOfTheGrain) {
  const MetallicRoughness truth{{0.8, 0.8, 0.8}, 1, 0.4, 0.6, true};
  const MetallicRoughnessFit fit = fit_metallic_roughness(truth);
  EXPECT_TRUE(fit.material.across);
  EXPECT_NEAR(fit.material.anisotropy, 0.6, 0.05);
  EXPECT_GE(fit.psnr, 40);
}

TEST(MetallicRoughnessFit, NeedsColours) {
  EXPECT_THROW(fit_metallic_roughness(FactoredBrdf(2, {}, {Lobe{{0.1, 0.2}, {}}})), Error);
}

}  // namespace
}  // namespace burnish
