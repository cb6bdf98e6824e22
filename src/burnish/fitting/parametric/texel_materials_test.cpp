// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/fit.h>
#include <burnish/fitting/parametric/metallic_roughness_fit.h>
#include <burnish/fitting/parametric/texel_materials.h>
#include <burnish/io/open_source.h>
#include <burnish/math/parallel.h>
#include <burnish/math/srgb.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

/// Two lobes, a gold of GGX .3 and a red diffuse one, and how much of each texels have.
SpatialBrdf gold_and_red(int side, const std::vector<float>& gold, const std::vector<float>& red) {
  const auto model_of = [](const char* spec) {
    return fit(open_source(spec, {}), {.form = Budget{.bytes = 2700, .fetches = 2}, .score = false}).model();
  };
  static const FactoredBrdf a = model_of("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.8/0.5/0.2"),
                            b = model_of("lambert:kd=0.5/0.2/0.1");
  // each model's lobes with the same weight
  std::vector<Table> tables(a.tables().begin(), a.tables().end());
  std::vector<Lobe> lobes(a.lobes().begin(), a.lobes().end());
  for (Lobe lobe : b.lobes()) {
    for (FactorUse& use : lobe.factors) use.table += a.tables().size();
    lobes.push_back(std::move(lobe));
  }
  for (Table table : b.tables()) {
    table.name += "2";
    tables.push_back(std::move(table));
  }
  SurfaceMaps maps;
  for (std::size_t k = 0; k < lobes.size(); ++k)
    maps.weights.emplace_back(side, side, 1, TableFormat::half, 1.0f, k < a.lobes().size() ? gold : red);
  return SpatialBrdf(FactoredBrdf(3, std::move(tables), std::move(lobes)), std::move(maps));
}

TEST(TexelMaterials, AreThoseOfTheTexelsWhereTheyCanBe) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const SpatialBrdf surface = gold_and_red(2, {1, 0, 1, 0}, {0, 1, 0, 1});
  const TexelMaterials found = nearest_materials(surface);
  ASSERT_EQ(found.metallic.size(), 4u);
  for (const std::size_t t : {0u, 2u}) {
    EXPECT_GT(found.metallic[t], 245);
    EXPECT_NEAR(found.roughness[t] / 255.0, std::sqrt(0.3), 0.02);
    const std::array<double, 3> f0{0.8, 0.5, 0.2};
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(srgb_decoded(found.base_color[3 * t + c] / 255.0), f0[c], 0.02);
  }
  for (const std::size_t t : {1u, 3u}) {
    EXPECT_EQ(found.metallic[t], 0);
    EXPECT_GT(found.base_color[3 * t], found.base_color[3 * t + 1]);
  }
  EXPECT_GT(found.psnr, 45);
}

TEST(TexelMaterials, AreNearlyWhatASearchOfPicturesFinds) {
  BURNISH_SKIP_WHERE_SANITIZED();
  // a metal that is a quarter paint: no material of glTF
  const SpatialBrdf surface = gold_and_red(1, {0.75f}, {0.25f});
  const MetallicRoughnessFit searched = fit_metallic_roughness(surface.at(0.5, 0.5));
  EXPECT_GT(nearest_materials(surface).psnr, searched.psnr - 1.5);
}

TEST(TexelMaterials, DoNotDependOnTheNumberOfThreads) {
  BURNISH_SKIP_WHERE_SANITIZED();
  std::vector<float> gold, red;
  for (int i = 0; i < 64; ++i) {
    gold.push_back(static_cast<float>(0.5 + 0.5 * std::sin(i)));
    red.push_back(static_cast<float>(0.5 + 0.5 * std::cos(3 * i)));
  }
  const SpatialBrdf surface = gold_and_red(8, gold, red);
  const TexelMaterials all = nearest_materials(surface);
  const ThreadLimit one(1);
  const TexelMaterials alone = nearest_materials(surface);
  EXPECT_EQ(all.base_color, alone.base_color);
  EXPECT_EQ(all.metallic, alone.metallic);
  EXPECT_EQ(all.roughness, alone.roughness);
  EXPECT_EQ(all.psnr, alone.psnr);
}

}  // namespace
}  // namespace burnish
