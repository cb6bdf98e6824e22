// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/choosing/fetch_plan.h>
#include <burnish/fitting/choosing/frontal_pixels.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/fitting/choosing/volume_forms.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/mirror_asymmetry.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

// Returns the bytes of a model of the spec, with texels of four bytes.
std::size_t bytes_of(const ModelSpec& spec) {
  LogModel model{.spec = spec, .channels = 3, .log_values = {}};
  for (const ModelSpec::TableSpec& table : spec.tables)
    model.log_values.emplace_back(3 * table.layout.node_count());
  return to_brdf(model, TableFormat::rgb9e5).bytes();
}

TEST(FetchPlan, KeepsBothLimitsAndUsesTheBytes) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3");
  for (const std::size_t bytes : {6'000u, 16'384u, 65'536u})
    for (int fetches = 1; fetches <= 24; ++fetches)
      for (const ModelSpec& spec : volume_specs(ggx.ref(), {.bytes = bytes, .fetches = fetches})) {
        EXPECT_LE(fetch_count(spec), static_cast<std::size_t>(fetches));
        EXPECT_LE(bytes_of(spec), bytes);
        EXPECT_GT(bytes_of(spec), bytes * 9 / 10);
      }
  EXPECT_THROW(volume_specs(ggx.ref(), {.bytes = 60}), Error);
}

TEST(FetchPlan, GivesATableOfWiWhereTheOrderOfTheDirectionsMatters) {
  const fixtures::Ordered source{{.a = 10, .b = 10}};
  const CostLimit limit{.bytes = 6'000, .fetches = 2};
  const std::vector<ModelSpec> specs = volume_specs(source, limit),
                               even = volume_specs(SymmetrizedBrdf(source), limit);
  ASSERT_EQ(specs.size(), 2 * even.size());
  EXPECT_EQ(volume_specs(source, {.bytes = 6'000, .fetches = 1}).size(), even.size());
  for (const ModelSpec& spec : specs) {
    EXPECT_LE(fetch_count(spec), 2u);
    EXPECT_LE(bytes_of(spec), 6'000u);
    EXPECT_GT(bytes_of(spec), 5'400u);
  }
  const TrainingSet set =
      draw_training_set(source, {.pictures = 4'000, .directions = 8'000, .crowded = true});
  const auto fit = [&](const std::vector<ModelSpec>& of) {
    return to_brdf(fit_volumes(set, of, {.smooth = 1e-9}).model, TableFormat::half);
  };
  const FactoredBrdf told = fit(specs), same = fit(even);
  EXPECT_FALSE(told.reciprocal());
  EXPECT_TRUE(same.reciprocal());
  const FigureOptions figures{.count = 5000, .image_size = 32};
  const double least = error_figures(source, told, figures).relative;
  EXPECT_LT(least, 0.02);
  EXPECT_LT(least, 0.3 * error_figures(source, same, figures).relative);
}

TEST(FetchPlan, TellsMirrorImagesApartInTwoFetches) {
  const fixtures::Twisted source{{.a = 10, .b = 10}};
  const CostLimit limit{.bytes = 6'000, .fetches = 2};
  const std::vector<ModelSpec> specs = volume_specs(source, limit);
  for (const ModelSpec& spec : specs) {
    EXPECT_LE(fetch_count(spec), 2u);
    EXPECT_LE(bytes_of(spec), 6'000u);
    EXPECT_GT(bytes_of(spec), 5'400u);
  }
  const TrainingSet set =
      draw_training_set(source, {.pictures = 4'000, .directions = 8'000, .crowded = true});
  const FigureOptions figures{.count = 5000, .image_size = 32};
  const FactoredBrdf told = to_brdf(fit_volumes(set, specs, {.smooth = 1e-9}).model, TableFormat::half);
  // Both ends of phi_s are one place.
  const Table& volume =
      *std::ranges::find(told.tables(), TableShape::volume, [](const Table& t) { return t.layout.shape; });
  const auto layer = static_cast<std::size_t>(volume.layout.width * volume.layout.height) * volume.channels;
  double apart = 0;
  for (std::size_t i = 0; i < layer; ++i)
    apart += std::abs(std::log(volume.values[i] / volume.values[volume.values.size() - layer + i]));
  EXPECT_LT(apart / static_cast<double>(layer), 0.02);
  // A model that is its own mirror image cannot have a smaller error.
  const double least = std::expm1(mirror_asymmetry(source));
  EXPECT_GT(least, 0.05);
  EXPECT_LT(error_figures(source, told, figures).relative, 0.3 * least);
}

TEST(FetchPlan, LeavesFewBytesOfAnisotropicSourcesToLobes) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3");
  EXPECT_FALSE(takes_lobes(ggx.ref(), {.bytes = 16'384, .fetches = 2}));
  for (int fetches = 1; fetches <= 9; ++fetches) {
    const CostLimit limit{.bytes = 2'700, .fetches = fetches};
    ASSERT_TRUE(takes_lobes(ggx.ref(), limit));
    const LobePlan plan = plan_within(ggx.ref(), limit);
    EXPECT_LE(fetch_count(plan_to_spec(plan, 2'700, 3, 4)), static_cast<std::size_t>(fetches));
  }
}

TEST(FetchPlan, LeavesFewBytesToLines) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3");
  EXPECT_TRUE(takes_lobes(ggx.ref(), {.bytes = 2700, .fetches = 24}));
  EXPECT_FALSE(takes_lobes(ggx.ref(), {.bytes = 2700, .fetches = 2}));
  EXPECT_FALSE(takes_lobes(ggx.ref(), {.bytes = 16'384, .fetches = 24}));
}

TEST(FetchPlan, TriesFewFetchesAndManyAndTakesTheKnee) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2");
  const TrainingSet set =
      draw_training_set(ggx.ref(), {.pictures = 8'000, .directions = 12'000, .crowded = true});
  for (const std::size_t bytes : {2'700u, 16'384u}) {
    const auto trials = try_fetches(ggx.ref(), set, {.bytes = bytes}, {});
    ASSERT_GT(trials.size(), 3u);
    EXPECT_EQ(trials.front().fetches, 2);
    for (std::size_t k = 1; k < trials.size(); ++k) EXPECT_GT(trials[k].fetches, trials[k - 1].fetches);
    EXPECT_EQ(trials.back().lobes, takes_lobes(ggx.ref(), {.bytes = bytes, .fetches = 24}));
    const FetchTrial& knee = trial_at_knee(trials);
    for (const FetchTrial& trial : trials) {
      EXPECT_GT(trial.error, 0);
      EXPECT_LE(knee.error, kKneeFactor * trial.error);
      if (trial.fetches < knee.fetches) {
        EXPECT_GT(trial.error, knee.error);
      }
    }
  }
  EXPECT_TRUE(try_fetches(ggx.ref(), set, {.bytes = 60}, {}).empty());
}

TEST(FetchPlan, FrontalPixelsHaveOneDirectionAndStandAmongThePixels) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3");
  const TrainingSet set = draw_training_set(ggx.ref(), {.pictures = 1000, .directions = 500}),
                    more = with_frontal_pixels(ggx.ref(), set, 0.1);
  ASSERT_EQ(more.size() - set.size(), more.picture_count - set.picture_count);
  EXPECT_NEAR(static_cast<double>(more.picture_count - set.picture_count), 100, 2);
  double weight = 0;
  for (std::size_t i = set.picture_count; i < more.picture_count; ++i) {
    EXPECT_EQ(more.pairs[i].wi, more.pairs[i].wo);
    weight += static_cast<double>(more.weights[i]) / 100;
  }
  EXPECT_NEAR(weight, 1, 0.05);  // the weight of evenly spread pixels
  EXPECT_EQ(more.values.size(), 3 * more.size());
  EXPECT_EQ(more.pairs.back().wi, set.pairs.back().wi);
}

TEST(FetchPlan, FitsGgxWithTwoFetches) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2");
  const CostLimit limit{.bytes = 8'000, .fetches = 2};
  const TrainingSet set =
      draw_training_set(ggx.ref(), {.pictures = 6'000, .directions = 10'000, .crowded = true});
  const LobesFit fit = fit_volumes(set, volume_specs(ggx.ref(), limit), {.smooth = 1e-9});
  // The bounds are relative and log_cos errors of about a percent, and pictures of 40 dB.
  EXPECT_LT(objective(fit.model, set, {.relative = 1}), std::log(0.02));
  EXPECT_LT(objective(fit.model, set, {.log_cos = 1}), std::log(0.01));
  EXPECT_LT(objective(fit.model, set, {.pictures = 1}), std::log(1e-4));
}

}  // namespace
}  // namespace burnish
