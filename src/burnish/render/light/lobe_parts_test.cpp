// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/render/light/lobe_parts.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

/// The lobe alone.
FactoredBrdf one_of(const FactoredBrdf& brdf, const Lobe& lobe) {
  return {brdf.channels(), {brdf.tables().begin(), brdf.tables().end()}, {lobe}};
}

TEST(LobeParts, MultiplyToTheLobe) {
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model);
    for (const Lobe& lobe : brdf.lobes()) {
      const LobeParts parts = parts_of(brdf, lobe);
      const FactoredBrdf whole = one_of(brdf, lobe);
      for (const auto& [wi, wo] : corner_and_random_pairs(300)) {
        const Channels f = eval_channels(whole, wi, wo), outside = eval_channels(parts.outside, wi, wo),
                       inside = eval_channels(parts.inside, wi, wo);
        // one order of the product and another
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(outside[c] * inside[c], f[c], 1e-14 * f[c]) << model.name;
      }
    }
  }
}

TEST(LobeParts, AreOutsideWhatTheLightDoesNotChange) {
  const FactoredBrdf brdf = random_model("p(wo) q(h) p(wi) u(wo,wo) v(wo,wi)",
                                         {"p=8", "q=9", "u=3x4", "v=3x4"}, 3, TableFormat::single);
  const LobeParts parts = parts_of(brdf, brdf.lobes()[0]);
  EXPECT_EQ(parts.outside.lobes()[0].factors.size(), 2u);
  EXPECT_EQ(parts.inside.lobes()[0].factors.size(), 3u);
  EXPECT_EQ(parts.outside.lobes()[0].scale, brdf.lobes()[0].scale);
  const Vec3 wo = normalize({0.3, 0.2, 0.8});
  EXPECT_EQ(eval_channels(parts.outside, {0, 0, 1}, wo), eval_channels(parts.outside, {0.6, 0, 0.8}, wo));
}

TEST(LobeParts, JoinedAreTheirSumWithEachTableOnce) {
  const FactoredBrdf brdf = smooth_model(model_case("ThreeLobes"));
  std::vector<FactoredBrdf> lobes;
  for (const Lobe& lobe : brdf.lobes()) {
    const LobeParts parts = parts_of(brdf, lobe);
    lobes.push_back(parts.inside);
  }
  const FactoredBrdf all = joined(lobes);
  EXPECT_EQ(all.tables().size(), brdf.tables().size());
  ASSERT_EQ(all.lobes().size(), lobes.size());
  for (const auto& [wi, wo] : corner_and_random_pairs(200)) {
    Channels sum{};
    for (const FactoredBrdf& lobe : lobes)
      for (std::size_t c = 0; c < 3; ++c) sum[c] += eval_channels(lobe, wi, wo)[c];
    const Channels f = eval_channels(all, wi, wo);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], sum[c], 1e-14 * sum[c]);
  }
}

}  // namespace
}  // namespace burnish
