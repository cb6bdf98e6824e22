#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/plans/fetch_plan.h>
#include <burnish/fitting/plans/hemisphere_plan.h>
#include <burnish/fitting/plans/spec_layout.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>

namespace burnish {
namespace {

FactoredBrdf flat(const ModelSpec& spec) {
  LogModel model{.spec = spec, .channels = 1, .log_values = {}};
  for (const ModelSpec::TableSpec& table : spec.tables)
    model.log_values.emplace_back(table.layout.node_count());
  return to_brdf(model, TableFormat::half);
}

TEST(HemispherePlan, KeepsBothLimitsAndUsesTheBytes) {
  for (const std::size_t channels : {1u, 3u})
    for (const std::size_t bytes : {5'000u, 16'384u, 65'536u}) {
      for (int fetches = 1; fetches <= 6; ++fetches) {
        const CostLimit limit{.bytes = bytes, .texel_bytes = channels == 1 ? 2u : 4u, .fetches = fetches};
        const std::vector<ModelSpec> specs = hemisphere_specs(limit, channels);
        for (const ModelSpec& spec : specs) {
          EXPECT_LE(fetch_count(spec), static_cast<std::size_t>(fetches));
          EXPECT_LE(bytes_of(spec, limit.texel_bytes, channels), bytes);
          EXPECT_GT(bytes_of(spec, limit.texel_bytes, channels), bytes * 9 / 10);
        }
      }
    }
  EXPECT_THROW(hemisphere_specs({.bytes = 40, .texel_bytes = 2}, 1), Error);
}

TEST(HemispherePlan, GivesReciprocalModels) {
  for (const ModelSpec& spec : hemisphere_specs({.bytes = 16'384, .texel_bytes = 2, .fetches = 6}, 1)) {
    EXPECT_TRUE(flat(spec).reciprocal());
    // what tells mirror images apart has one place at both ends
    for (const auto& lobe : spec.lobes)
      for (const FactorUse& use : lobe)
        if (spec.tables[use.table].layout.shape == TableShape::volume) {
          EXPECT_EQ(spec.tables[use.table].circle_z, use.projection_z == kProjectSide);
        }
  }
}

TEST(HemispherePlan, CountsWhatAModelTakes) {
  for (const ModelSpec& spec : hemisphere_specs({.bytes = 9'000, .texel_bytes = 2, .fetches = 6}, 1))
    EXPECT_EQ(flat(spec).bytes(), bytes_of(spec, 2, 1));
}

TEST(HemispherePlan, FitsBrushedMetalBetterTheMoreItMayCost) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.15,alpha_y=0.4,kd=0.2");
  const TrainingSet set = with_frontal_pixels(
      ggx.ref(), draw_training_set(ggx.ref(), {.pictures = 12'000, .directions = 24'000}), 0.1);
  const TrainingSet unseen =
      draw_training_set(ggx.ref(), {.pictures = 3'000, .directions = 6'000, .seed = 5});
  const auto error = [&](std::size_t bytes, int fetches, const ErrorTerms& of) {
    const LobesFit fit =
        fit_hemispheres(set, hemisphere_specs({.bytes = bytes, .fetches = fetches}, 3), {.smooth = 1e-6});
    return objective(fit.model, unseen, of);
  };
  const double one = error(8'000, 1, {.relative = 1}), two = error(8'000, 2, {.relative = 1}),
               five = error(8'000, 5, {.relative = 1});
  EXPECT_LT(two, one);
  EXPECT_LT(five, two);
  EXPECT_LT(five, std::log(0.02));
  EXPECT_LT(error(24'000, 5, {.relative = 1}), five + 0.1);
}

}  // namespace
}  // namespace burnish
