// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/fitting/choosing/overfit.h>
#include <burnish/reflectance/analytic.h>

namespace burnish {
namespace {

TEST(FitWithoutOverfit, IsSmootherWhereThatPredictsBetterAndNowhereElse) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2");
  constexpr std::size_t kManyBytes = 3200, kScantBytes = 200, kHalf = 2;
  const LobePlan plan = default_plan(kManyBytes, 1, true, kHalf);
  const RefineOptions given{.max_iterations = 4};
  const TrainingSet other = draw_training_set(ggx, {.pictures = 500, .directions = 1500, .seed = 9});
  const TrainingSet few = draw_training_set(ggx, {.pictures = 80, .directions = 300});
  const SmoothFit smoother = fit_without_overfit(ggx, few, plan, kManyBytes, kHalf, {}, given);
  EXPECT_GT(smoother.smooth, given.smooth);
  EXPECT_LT(objective(smoother.fit.model, other, given.shares),
            objective(fit_plan(few, plan, kManyBytes, kHalf, given).model, other, given.shares));

  const TrainingSet many = draw_training_set(ggx, {.pictures = 1000, .directions = 4000});
  const LobePlan small = default_plan(kScantBytes, 1, true, kHalf);
  const SmoothFit same = fit_without_overfit(ggx, many, small, kScantBytes, kHalf, {}, given);
  EXPECT_EQ(same.smooth, given.smooth);
  EXPECT_EQ(same.fit.model.log_values, fit_plan(many, small, kScantBytes, kHalf, given).model.log_values);
}

}  // namespace
}  // namespace burnish
