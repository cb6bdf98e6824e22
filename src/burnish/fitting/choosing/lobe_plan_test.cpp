// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/compact_file.h>
#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::kHalfRgb;

FactoredBrdf zero_model(const ModelSpec& spec, std::size_t channels) {
  LogModel model{.spec = spec, .channels = channels, .log_values = {}};
  for (std::size_t t = 0; t < spec.tables.size(); ++t)
    model.log_values.emplace_back(spec.tables[t].layout.node_count() * model.step(t));
  return to_brdf(model, TableFormat::half);
}

TEST(LobePlan, FillsItsBytesAndNoMore) {
  for (const bool isotropic : {true, false})
    for (const std::size_t bytes : {1350u, 2700u, 16384u, 65536u}) {
      if (!isotropic && bytes < 2000) continue;
      const LobePlan plan = default_plan(bytes, 0, isotropic, kHalfRgb);
      const FactoredBrdf brdf = zero_model(plan_to_spec(plan, bytes, 3, kHalfRgb), 3);
      EXPECT_LE(brdf.bytes(), bytes);
      EXPECT_GT(static_cast<double>(brdf.bytes()), 0.8 * static_cast<double>(bytes)) << bytes << isotropic;
      EXPECT_EQ(brdf.isotropic(), isotropic);
      EXPECT_TRUE(brdf.reciprocal());
    }
}

// Plans keep the promise of compact_file.h, whatever the values are.
TEST(LobePlan, MakesCompactFiles) {
  struct {
    std::size_t texel_bytes;
    TableFormat format;
    std::size_t channels;
  } const kinds[] = {{4, TableFormat::rgb9e5, 3}, {6, TableFormat::half, 3}, {2, TableFormat::half, 1}};
  for (const auto& [texel_bytes, format, channels] : kinds)
    for (const bool isotropic : {true, false})
      for (std::size_t bytes = 300; bytes < 140'000; bytes += bytes / 8) {
        const LobePlan plan = default_plan(bytes, 0, isotropic, texel_bytes);
        if (!plan_fits(plan, bytes, channels, texel_bytes)) continue;
        const FactoredBrdf zero = zero_model(plan_to_spec(plan, bytes, channels, texel_bytes), channels);
        std::vector<Lobe> lobes(zero.lobes().begin(), zero.lobes().end());
        for (Lobe& lobe : lobes) std::ranges::fill(lobe.scale, 49383772161.0f);
        const FactoredBrdf brdf(channels, {zero.tables().begin(), zero.tables().end()}, lobes, format);
        const std::size_t size = format_compact({.brdf = brdf}).size();
        EXPECT_LE(size, 256 + brdf.table_bytes() * 21 / 20)
            << bytes << " bytes, " << channels << " channels, " << lobes.size() << " lobes";
      }
}

TEST(LobePlan, SharesTablesAmongLobesAndChannels) {
  for (const std::size_t texel : {std::size_t{4}, kHalfRgb}) {
    LobePlan plan = default_plan(2700, 3, true, texel);
    const std::size_t own = plan_to_spec(plan, 2700, 3, texel).tables.size();
    plan.factors[0].every_lobe = plan.factors[2].grey = true;
    const ModelSpec spec = plan_to_spec(plan, 2700, 3, texel);
    EXPECT_EQ(spec.tables.size(), own - 2);
    EXPECT_EQ(spec.tables[0].name, plan.factors[0].name);
    EXPECT_EQ(std::ranges::count(spec.tables, true, &ModelSpec::TableSpec::shared), 3);
    LogModel model{.spec = spec, .channels = 3, .log_values = {}};
    for (std::size_t t = 0; t < spec.tables.size(); ++t)
      model.log_values.emplace_back(spec.tables[t].layout.node_count() * model.step(t));
    const FactoredBrdf brdf = to_brdf(model, texel == 4 ? TableFormat::rgb9e5 : TableFormat::half);
    EXPECT_LE(brdf.bytes(), 2700u);
    EXPECT_GT(brdf.bytes(), 2600u);
  }
}

TEST(LobePlan, GivesAGridTheWidthItIsPlannedWith) {
  LobePlan plan = default_plan(2700, 2, true, kHalfRgb);
  plan.factors.push_back(
      {.name = "w", .shape = TableShape::grid, .uses = {kProjectTwist}, .share = 0.3, .width = 4});
  const ModelSpec spec = plan_to_spec(plan, 2700, 3, kHalfRgb);
  const auto grid = std::ranges::find(spec.tables, "w1", &ModelSpec::TableSpec::name);
  ASSERT_NE(grid, spec.tables.end());
  EXPECT_EQ(grid->layout.width, 4);
  EXPECT_GT(grid->layout.height, 4);
}

TEST(LobePlan, RefusesWhatDoesNotFit) {
  LobePlan same = default_plan(2700, 2, true, kHalfRgb);
  for (PlannedFactor& factor : same.factors) factor.every_lobe = true;
  EXPECT_THROW(plan_to_spec(same, 2700, 3, kHalfRgb), Error);
  EXPECT_THROW(plan_to_spec(default_plan(100, 1, true, kHalfRgb), 100, 3, kHalfRgb), Error);
  EXPECT_THROW(plan_to_spec(default_plan(0, 1, true, kHalfRgb), 0, 3, kHalfRgb), Error);
  EXPECT_THROW(plan_to_spec(default_plan(300, 40, true, kHalfRgb), 300, 3, kHalfRgb), Error);
  EXPECT_THROW(plan_to_spec(default_plan(200, 2, false, kHalfRgb), 200, 3, kHalfRgb), Error);
  EXPECT_THROW(default_plan(2700, 1, false, kHalfRgb), Error);
}

// A plain source for twisted and ordered variants, and the bytes of its plans.
constexpr fixtures::Glossy kEven{.a = 10, .b = 10};
constexpr std::size_t kBytes = 1500, kFewBytes = 180;

LobePlan plain_plan() {
  return default_plan(kBytes, 0, true, kHalfRgb);
}
FactoredBrdf fitted(const TrainingSet& set, const LobePlan& plan) {
  FactoredBrdf brdf =
      to_brdf(fit_plan(set, plan, kBytes, kHalfRgb, {.max_iterations = 10}).model, TableFormat::half);
  EXPECT_LE(brdf.bytes(), kBytes);
  return brdf;
}
double relative_error(BrdfRef source, const FactoredBrdf& brdf) {
  return error_figures(source, brdf, {.count = 5000, .image_size = 32}).relative;
}

TEST(PlanFor, TellsMirrorImagesApartWhereTheSourceDoes) {
  const fixtures::Twisted source{kEven};
  EXPECT_EQ(plan_for(kEven, kBytes, 0, kHalfRgb), plain_plan());
  const AnalyticBrdf brushed = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.5");
  EXPECT_EQ(plan_for(brushed, kBytes, 0, kHalfRgb), default_plan(kBytes, 0, false, kHalfRgb));

  const TrainingSet set = draw_training_set(source, {.pictures = 2000, .directions = 5000});
  const FactoredBrdf told = fitted(set, plan_for(source, kBytes, 0, kHalfRgb)),
                     same = fitted(set, plain_plan());
  for (const FactoredBrdf* brdf : {&told, &same}) EXPECT_TRUE(brdf->isotropic() && brdf->reciprocal());
  EXPECT_LT(relative_error(source, told), 0.3 * relative_error(source, same));
  // Few bytes have no room for the factor.
  EXPECT_EQ(plan_for(source, kFewBytes, 1, kHalfRgb), default_plan(kFewBytes, 1, true, kHalfRgb));
  EXPECT_TRUE(plan_fits(default_plan(kFewBytes, 1, true, kHalfRgb), kFewBytes, 3, kHalfRgb));
}

TEST(PlanFor, TellsTheDirectionsApartWhereTheirOrderMatters) {
  const fixtures::Ordered source{kEven};
  EXPECT_EQ(plan_for(SymmetrizedBrdf(source), kBytes, 0, kHalfRgb), plain_plan());

  const TrainingSet set = draw_training_set(source, {.pictures = 2000, .directions = 5000});
  const FactoredBrdf told = fitted(set, plan_for(source, kBytes, 0, kHalfRgb)),
                     same = fitted(set, plain_plan());
  EXPECT_FALSE(told.reciprocal());
  EXPECT_TRUE(same.reciprocal());
  EXPECT_LT(relative_error(source, told), 0.02);
  EXPECT_LT(relative_error(source, told), 0.3 * relative_error(source, same));
  // Few bytes have no room for the tables.
  EXPECT_EQ(plan_for(source, kFewBytes, 1, kHalfRgb), default_plan(kFewBytes, 1, true, kHalfRgb));
}

}  // namespace
}  // namespace burnish
