// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/fitting/parametric/gltf_fit.h>
#include <burnish/fitting/parametric/grain.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

PicturePairs pairs_of(BrdfRef brdf) {
  return picture_pairs(brdf, Scorer(brdf, {.count = 100, .image_size = 64}).exposure());
}

GltfMaterial recovered(const GltfMaterial& truth) {
  return fit_gltf(pairs_of(truth), {.anisotropic = !truth.isotropic(), .tangent = grain_direction(truth)})
      .material;
}

void expect_near(Rgb found, Rgb truth) {
  EXPECT_NEAR(found.r, truth.r, 0.01 * truth.r + 1e-4);
  EXPECT_NEAR(found.g, truth.g, 0.01 * truth.g + 1e-4);
  EXPECT_NEAR(found.b, truth.b, 0.01 * truth.b + 1e-4);
}

TEST(GltfFit, RecoversAMetalWithoutExtensions) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const GltfMaterial metal{.base_color = {0.9, 0.6, 0.3}, .metallic = 1, .roughness = 0.4};
  const GltfMaterial found = recovered(metal);
  expect_near(found.base_color, metal.base_color);
  expect_near(found.metallic, metal.metallic);
  expect_near(found.roughness, metal.roughness);
  EXPECT_EQ(found,
            (GltfMaterial{
                .base_color = found.base_color, .metallic = found.metallic, .roughness = found.roughness}));
}

TEST(GltfFit, RecoversACoatedGrain) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const GltfMaterial brushed{.base_color = {0.3, 0.5, 0.8},
                             .metallic = 1,
                             .roughness = 0.5,
                             .anisotropy = 0.5,
                             .rotation = 0.5,
                             .clearcoat = 0.8,
                             .clearcoat_roughness = 0.15};
  const GltfMaterial found = recovered(brushed);
  expect_near(found.base_color, brushed.base_color);
  expect_near(found.roughness, brushed.roughness);
  EXPECT_NEAR(found.rotation, brushed.rotation, 0.01);
  expect_near(found.anisotropy, brushed.anisotropy);
  expect_near(found.clearcoat, brushed.clearcoat);
  expect_near(found.clearcoat_roughness, brushed.clearcoat_roughness);
  EXPECT_EQ(found.sheen_color, Rgb(0));
  EXPECT_EQ(found.iridescence, 0);
}

TEST(GltfFit, RecoversAClothWithSheen) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const GltfMaterial cloth{.base_color = {0.4, 0.1, 0.05},
                           .metallic = 0,
                           .roughness = 0.8,
                           .sheen_color = {0.7, 0.5, 0.2},
                           .sheen_roughness = 0.4};
  const GltfMaterial found = recovered(cloth);
  expect_near(found.base_color, cloth.base_color);
  expect_near(found.sheen_color, cloth.sheen_color);
  expect_near(found.sheen_roughness, cloth.sheen_roughness);
  EXPECT_EQ(found.clearcoat, 0);
}

TEST(GltfFit, RecoversAFilmThatColoursTheHighlight) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const GltfMaterial soap{.base_color = {0.5, 0.5, 0.5},
                          .metallic = 1,
                          .roughness = 0.4,
                          .iridescence = 1,
                          .iridescence_ior = 1.6,
                          .iridescence_thickness = 450};
  const GltfMaterial found = recovered(soap);
  expect_near(found.iridescence_thickness * found.iridescence_ior,
              soap.iridescence_thickness * soap.iridescence_ior);
  EXPECT_GT(found.iridescence, 0.5);
}

// Which would earn .05 dB or more, and be another film in other programs.
TEST(GltfFit, LeavesOutAFilmThatEarnsLittle) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const AnalyticBrdf cloth = parse_analytic("openpbr:fuzz_weight=1,fuzz_color=0,base_color=0.2/0.2/0.6");
  EXPECT_EQ(fit_gltf(pairs_of(cloth.ref())).material.iridescence, 0);
}

// Another formula's coat and base: closer than any core material is.
TEST(GltfFit, SaysOfOpenPbrWhatExtensionsCan) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const AnalyticBrdf paint = parse_analytic(
      "openpbr:base_color=0.5/0.1/0.05,specular_roughness=0.6,coat_weight=1,coat_roughness=0.15");
  const Scorer scorer(paint.ref(), {.count = 1000, .image_size = 64});
  const GltfFit fit = fit_gltf(picture_pairs(paint.ref(), scorer.exposure()));
  EXPECT_GT(fit.material.clearcoat, 0.3);
  EXPECT_GT(scorer.score(fit.material).psnr, 34);
  EXPECT_LT(fit.summary.error_after, fit.summary.error_before);
}

TEST(GltfFit, IsTheSameForEveryNumberOfThreads) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const AnalyticBrdf brdf = parse_analytic("ashikhmin_shirley:exponent_x=80,exponent_y=20");
  const PicturePairs pairs = pairs_of(brdf.ref());
  const auto fitted = [&](int threads) {
    const ThreadLimit limit(threads);
    return fit_gltf(pairs, {.anisotropic = true}).material;
  };
  EXPECT_EQ(fitted(1), fitted(4));
}

TEST(GltfFit, KeepsGreySourcesGrey) {
  const AnalyticBrdf brdf = parse_analytic("beckmann:alpha_x=0.3,alpha_y=0.3,f0=0.4,kd=0.2");
  BURNISH_SKIP_WHERE_SANITIZED();
  const PicturePairs pairs = pairs_of(brdf.ref());
  const GltfMaterial found = fit_gltf(pairs, {.grey = true}).material;
  for (const Rgb color : {found.base_color, found.specular_color, found.sheen_color}) {
    EXPECT_EQ(color.r, color.g);
    EXPECT_EQ(color.r, color.b);
  }
}

}  // namespace
}  // namespace burnish
