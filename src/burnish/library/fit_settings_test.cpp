// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/library/fit_settings.h>

namespace burnish {
namespace {

// Batches are resumed by digests of this text: where it changes, all their materials are fitted again.
TEST(FitSettings, WriteWhatEarlierBatchesHaveInTheirDigests) {
  const std::string after =
      R"(,"target":null,"smooth":null,"samples":0,"seed":1,"symmetrize":true,"conserve_energy":false,"score":true})";
  const std::string loss =
      R"("loss":"image","scattered":{"cross_validate":false,"reweightings":null,"floor":3e-05}})";
  EXPECT_EQ(settings_text(FitOptions{}), R"({"form":null)" + after);
  EXPECT_EQ(settings_text(FitOptions{.form = DefaultBudget{}}),
            R"({"form":{"bytes":16384,"fetches":null,"lobes":0,"search":false,)" + loss + after);
  EXPECT_EQ(settings_text(FitOptions{.form = Budget{.bytes = 2700}}),
            R"({"form":{"bytes":2700,"fetches":0,"lobes":0,"search":false,)" + loss + after);
  EXPECT_EQ(settings_text(FitOptions{.form = Budget{.bytes = {}, .fetches = 2}}),
            R"({"form":{"bytes":null,"fetches":2,"lobes":0,"search":false,)" + loss + after);
  EXPECT_EQ(settings_text(FitOptions{.form = BaselineMethod{.method = "svd"}}),
            R"({"form":{"method":"svd","bytes":0})" + after);
}

TEST(FitSettings, TellOptionsThatDifferApart) {
  const auto text = [](FitOptions options) { return settings_text(options); };
  EXPECT_NE(text({.form = Budget{.bytes = 2700}}), text({.form = Budget{.bytes = 2700, .fetches = 2}}));
  EXPECT_NE(text({.form = Budget{.bytes = 2700}}), text({.form = Budget{.bytes = 2700, .lobes = 2}}));
  EXPECT_NE(text({.form = Budget{.bytes = kDefaultBudget}}), text({.form = DefaultBudget{}}));
  EXPECT_NE(text({.samples = 100}), text({}));
  EXPECT_NE(text({.form = BaselineMethod{.method = "svd", .bytes = 400}}),
            text({.form = BaselineMethod{.method = "svd"}}));
}

}  // namespace
}  // namespace burnish
