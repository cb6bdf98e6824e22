// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/refinement/refine.h>
#include <burnish/math/parallel.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::evaluate;
using fixtures::random_model;
using fixtures::small_set;

TEST(Refine, RecoversASumOfTwoLobes) {
  const LogModel truth = random_model("p(wo) p(wi) q(h) + s(h) t(theta_d)", {"p=5", "q=9", "s=5", "t=7"}, 1);
  TrainingSet set = small_set(parse_analytic("lambert"), 4000);
  const std::vector<double> f = evaluate(truth, set);
  set.channels = 1;
  set.values.assign(f.begin(), f.end());
  const LobesFit fit =
      fit_lobes(set, truth.spec, {.smooth = 0, .max_iterations = 100, .least_progress = 1e-6});
  const std::vector<double> g = evaluate(fit.model, set);
  double worst = 0;
  for (std::size_t i = 0; i < f.size(); ++i) worst = std::max(worst, std::abs(std::log(g[i] / f[i])));
  EXPECT_LT(worst, 0.02);
  EXPECT_LT(fit.summary.error_after, fit.summary.error_before);
}

TEST(Refine, RecoversALineTimesAVolume) {
  const LogModel truth = random_model("z(theta_h) g(theta_h,theta_d,phi_d)", {"z=40", "g=16x12x8"},
                                      1);  // too large for a dense matrix
  TrainingSet set = small_set(parse_analytic("lambert"), 20'000);
  const std::vector<double> f = evaluate(truth, set);
  set.channels = 1;
  set.values.assign(f.begin(), f.end());
  const LobesFit fit =
      fit_lobes(set, truth.spec, {.smooth = 0, .max_iterations = 40, .least_progress = 1e-6});
  const std::vector<double> g = evaluate(fit.model, set);
  double sum = 0;
  for (std::size_t i = 0; i < f.size(); ++i) sum += std::abs(std::log(g[i] / f[i]));
  EXPECT_LT(sum / static_cast<double>(f.size()), 0.01);
}

TEST(Refine, ChannelsOfTheSameDataAreOneChannel) {
  // of three channels the last is the first again
  const std::vector<std::string> sizes{"z=7", "s=5"};
  const ModelSpec spec = parse_model_spec("z(theta_h) + s(theta_d)", sizes, true);
  TrainingSet grey = small_set(parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2"), 2000);
  const std::size_t pairs = grey.size(), before = grey.channels;
  TrainingSet set = grey;
  set.channels = 3;
  set.values.clear();
  grey.channels = 1;
  std::vector<float> values;
  for (std::size_t i = 0; i < pairs; ++i) {
    const float v = grey.values[i * before];
    values.push_back(v);
    for (const float f : {v, 2 * v + 0.1f, v}) set.values.push_back(f);
  }
  grey.values = std::move(values);
  const RefineOptions options{.max_iterations = 5};
  const LobesFit fit = fit_lobes(set, spec, options), alone = fit_lobes(grey, spec, options);
  bool differs = false;
  for (std::size_t t = 0; t < spec.tables.size(); ++t)
    for (std::size_t n = 0; n < alone.model.log_values[t].size(); ++n) {
      const double* const logs = fit.model.log_values[t].data() + 3 * n;
      EXPECT_EQ(logs[0], alone.model.log_values[t][n]);
      EXPECT_EQ(logs[2], logs[0]);
      differs = differs || logs[1] != logs[0];
    }
  EXPECT_TRUE(differs);
}

TEST(Refine, DoesNotDependOnTheNumberOfThreads) {
  const TrainingSet set = small_set(parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2"), 2000);
  const LobePlan plan = default_plan(600, 2, true, 6);
  const auto fit = [&](int threads) {
    const ThreadLimit limit(threads);
    return fit_plan(set, plan, 600, 6, {.max_iterations = 4}).model.log_values;
  };
  EXPECT_EQ(fit(1), fit(2));
  const auto of_volume = [&](int threads) {
    const ThreadLimit limit(threads);
    LogModel model = random_model("z(theta_h) g(theta_h,theta_d,phi_d)", {"z=40", "g=16x12x8"}, 3);
    refine(model, set, {.max_iterations = 2});
    return model.log_values;
  };
  EXPECT_EQ(of_volume(1), of_volume(2));
}

// of a dense matrix, a sparse one and one of products with the data
TEST(ChannelRefinement, GoesOnWhereAnotherStopped) {
  const TrainingSet set = small_set(parse_analytic("ggx:alpha_x=0.3,alpha_y=0.5,kd=0.1"), 2000);
  for (const auto& [spec, tables] : std::vector<std::pair<const char*, std::vector<std::string>>>{
           {"pqp", {"p=5x5", "q=9x9"}},
           {"z(theta_h) g(theta_h,theta_d,phi_d)", {"z=40", "g=16x12x8"}},
           {"pqp", {"p=5x5", "q=45x45"}}}) {
    const LogModel start = random_model(spec, tables, 3);
    LogModel whole = start, parts = start;
    refine(whole, set, {.max_iterations = 5});
    const Lookups lookups = lookups_of(start.spec, set);
    for (std::size_t c = 0; c < 3; ++c) {
      const RefineOptions options{.max_iterations = 5, .channel = c};
      ChannelRefinement first(start, set, lookups, options), second(start, set, lookups, options);
      first.run(2);
      second.go_on_from(first.state());
      second.run(5);
      second.finish(parts);
    }
    EXPECT_EQ(parts.log_values, whole.log_values) << tables.back();
  }
}

TEST(Refine, IteratesWhereTheMatrixWouldBeTooLarge) {
  // 45 x 45 nodes are more than the direct solver takes
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.5,kd=0");
  const TrainingSet set = small_set(ggx, 3000);
  LogModel model = fit_one_lobe(parse_model_spec("pqp", std::vector<std::string>{"p=5x5", "q=45x45"}, false),
                                set, set.values, {.smooth = 1e-6});
  const FitSummary summary = refine(model, set, {.smooth = 1e-8, .max_iterations = 3});
  EXPECT_LT(summary.error_after, summary.error_before - 0.2);
}

TEST(Refine, RefusesBadOptions) {
  const TrainingSet set = small_set(parse_analytic("lambert"), 100);
  LogModel model = random_model("pqp", {}, 3);
  EXPECT_THROW(refine(model, set, {.smooth = -1}), Error);
  EXPECT_THROW(refine(model, set, {.max_iterations = -1}), Error);
  LogModel grey = random_model("pqp", {}, 1);
  EXPECT_THROW(refine(grey, set, {}), Error);
}

}  // namespace
}  // namespace burnish
