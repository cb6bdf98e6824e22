// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/choosing/frontal_pixels.h>
#include <burnish/fitting/choosing/hemisphere_plan.h>
#include <burnish/fitting/choosing/lay_out.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/log_models.h>
#include <burnish/testing/sanitized.h>

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
          EXPECT_LE(model_bytes(spec, channels, limit.texel_bytes), bytes);
          EXPECT_GT(model_bytes(spec, channels, limit.texel_bytes), bytes * 9 / 10);
        }
      }
    }
  EXPECT_THROW(hemisphere_specs({.bytes = 40, .texel_bytes = 2}, 1), Error);
}

TEST(HemispherePlan, GivesReciprocalModels) {
  for (const ModelSpec& spec : hemisphere_specs({.bytes = 16'384, .texel_bytes = 2, .fetches = 6}, 1)) {
    EXPECT_TRUE(flat(spec).reciprocal());
    // A table that distinguishes mirror images has one place at both ends.
    for (const auto& lobe : spec.lobes)
      for (const FactorUse& use : lobe)
        if (spec.tables[use.table].layout.shape == TableShape::volume) {
          EXPECT_EQ(spec.tables[use.table].circle_z, use.projection_z == kProjectSide);
        }
  }
}

TEST(HemispherePlan, CountsWhatAModelTakes) {
  for (const ModelSpec& spec : hemisphere_specs({.bytes = 9'000, .texel_bytes = 2, .fetches = 6}, 1))
    EXPECT_EQ(flat(spec).bytes(), model_bytes(spec, 1, 2));
}

/// Draws pixels, and twice as many pairs, of a grey brushed metal.
TrainingSet brushed_metal(std::size_t pictures, std::uint64_t seed) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.15,alpha_y=0.4,kd=0.2");
  const TrainingSet drawn =
      draw_training_set(ggx.ref(), {.pictures = pictures, .directions = 2 * pictures, .seed = seed});
  return mean_of_channels(with_frontal_pixels(ggx.ref(), drawn, 0.1));
}

TEST(HemispherePlan, TriesFormsAndSaysHowFarItIs) {
  const TrainingSet set = brushed_metal(600, 1);
  const std::vector<ModelSpec> specs = hemisphere_specs({.bytes = 700, .texel_bytes = 2, .fetches = 3}, 1);
  ASSERT_GT(specs.size(), 3u);
  std::vector<double> heard{0};
  const LobesFit fit =
      fit_hemispheres(set, specs, {.smooth = 1e-6, .max_iterations = 12, .progress = [&](double done) {
                                     EXPECT_GE(done, heard.back() - 1e-12);
                                     heard.push_back(done);
                                   }});
  EXPECT_EQ(heard.back(), 1);
  EXPECT_GT(heard.size(), specs.size());
  EXPECT_LT(objective(fit.model, brushed_metal(300, 5), {.relative = 1}), std::log(0.2));
}

TEST(HemispherePlan, TriesFewFetchesBesideLobes) {
  const TrainingSet set = brushed_metal(800, 1);
  const CostLimit limit{.bytes = 900, .texel_bytes = 2, .fetches = 1};
  const LobePlan lobes = default_plan(limit.bytes, 0, false, limit.texel_bytes);
  const RefineOptions options{.smooth = 1e-6, .max_iterations = 8};
  const FetchTrials tried = try_hemispheres(set, limit, options, lobes, options);
  ASSERT_GT(tried.trials.size(), 1u);
  ASSERT_EQ(tried.candidates.size(), tried.trials.size());
  const ModelSpec of_lobes = plan_to_spec(lobes, limit.bytes, 1, limit.texel_bytes);
  for (std::size_t k = 0; k < tried.trials.size(); ++k) {
    const FetchTrial& trial = tried.trials[k];
    EXPECT_GT(trial.error, 0);
    EXPECT_TRUE(k == 0 || trial.fetches > tried.trials[k - 1].fetches);
    const Candidate& candidate = tried.candidates[k];
    EXPECT_EQ(static_cast<std::size_t>(trial.fetches), fetch_count(trial.lobes ? of_lobes : candidate.spec));
    EXPECT_TRUE(trial.lobes || model_bytes(candidate.spec, 1, limit.texel_bytes) <= limit.bytes);
  }
  EXPECT_EQ(std::ranges::count(tried.trials, true, &FetchTrial::lobes), 1);
  EXPECT_TRUE(try_hemispheres(set, {.bytes = 40, .texel_bytes = 2}, options, lobes, options).trials.empty());
}

TEST(HemispherePlan, GoesOnFromTheMeanOfTheChannels) {
  // Green equals the mean of the channels, blue reflects a quarter of it, and red is zero.
  const TrainingSet grey = brushed_metal(600, 1);
  TrainingSet set = grey;
  set.channels = 3;
  set.values.clear();
  for (const float v : grey.values) set.values.insert(set.values.end(), {0, v, v / 4});
  const std::vector<ModelSpec> specs = hemisphere_specs({.bytes = 700, .texel_bytes = 6, .fetches = 3}, 3);
  const LobesFit fit = fit_hemispheres(set, specs, {.smooth = 1e-6, .max_iterations = 12});
  const TrainingSet unseen = brushed_metal(300, 5);
  const std::vector<double> f = fixtures::evaluate(fit.model, unseen);
  double apart = 0, red = 0, sum = 0;
  for (std::size_t i = 0; i < unseen.size(); ++i) {
    apart += std::abs(std::log(4 * f[3 * i + 2] / f[3 * i + 1]));
    red += f[3 * i];
    sum += f[3 * i + 1];
  }
  EXPECT_LT(apart / static_cast<double>(unseen.size()), 0.05);
  EXPECT_LT(red, 1e-3 * sum);
}

TEST(HemispherePlan, FitsBrushedMetalBetterTheMoreItMayCost) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const TrainingSet set = brushed_metal(12'000, 1), unseen = brushed_metal(3'000, 5);
  const auto error = [&](std::size_t bytes, int fetches) {
    const auto specs = hemisphere_specs({.bytes = bytes, .texel_bytes = 2, .fetches = fetches}, 1);
    return objective(fit_hemispheres(set, specs, {.smooth = 1e-6}).model, unseen, {.relative = 1});
  };
  const double one = error(4'000, 1), two = error(4'000, 2), five = error(4'000, 5);
  EXPECT_LT(two, one);
  EXPECT_LT(five, two);
  EXPECT_LT(five, std::log(0.02));
  EXPECT_LT(error(12'000, 5), five + 0.1);
}

}  // namespace
}  // namespace burnish
