// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/choosing/budget_ladder.h>
#include <burnish/math/random.h>
#include <burnish/metrics/measurement_quality.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

BudgetTrial trial(std::uint64_t bytes, double excess) {
  const ErrorLevel error{.relative = excess / 100, .log_cos = {}, .rms = {}, .psnr = {}};
  return {.bytes = bytes, .error = error, .excess = excess};
}

TEST(BudgetLadder, EndsAtTheNoiseOrWhereBytesHardlyHelp) {
  using Trials = std::vector<BudgetTrial>;
  EXPECT_EQ(stop_after(Trials{trial(700, 3)}, true), std::nullopt);
  EXPECT_EQ(stop_after(Trials{trial(700, 1)}, true), BudgetStop::noise);
  EXPECT_EQ(stop_after(Trials{trial(700, 1)}, false), BudgetStop::floor);
  EXPECT_EQ(stop_after(Trials{trial(700, 3), trial(1400, 2.8)}, true), BudgetStop::gain);
  EXPECT_EQ(stop_after(Trials{trial(700, 3), trial(1400, 2.6)}, true), std::nullopt);
  // The trials continue if only one of the errors falls.
  Trials relative{trial(700, 3), trial(1400, 3)};
  relative.back().error.relative = 0.02;
  EXPECT_EQ(stop_after(relative, true), std::nullopt);
  // Half a doubling needs half of that gain.
  EXPECT_EQ(stop_after(Trials{trial(10'000, 3), trial(14'142, 2.8)}, true), std::nullopt);
  EXPECT_EQ(stop_after(Trials{trial(32'768, 9), trial(65'536, 3)}, true), BudgetStop::largest);
}

TEST(NoiseScale, KnowsNoNoiseOfAFormula) {
  const Source source{"ggx", parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3"), {}};
  const NoiseScale scale(source, source.ref(), true, {.count = 500, .image_size = 16});
  EXPECT_FALSE(scale.noise());
  EXPECT_EQ(scale.excess({.relative = 0.01, .log_cos = {}, .rms = {}, .psnr = {}}), 0.01 / kMinRelative);
}

TEST(NoiseScale, TakesWhatExchangedDirectionsAndHeldOutNodesTell) {
  AngleTable layout;
  layout.folded = true;
  layout.axes = {make_axis({0}, kTwoPi), make_axis(cell_centres(10, kHalfPi)),
                 make_axis(cell_centres(10, kHalfPi)), make_axis(cell_centres(12, kPi))};
  AngleTable table = tabulate_angles(fixtures::Glossy{.a = 4, .b = 4}, layout);
  Pcg32 random(1);
  constexpr double kNoise = 0.2;
  // The noise is uniform and has variance 1, times kNoise.
  for (float& value : table.values)
    value *= static_cast<float>(std::exp(kNoise * std::sqrt(12) * (random.uniform() - 0.5)));
  const Source source{"noisy", std::move(table), {}};
  const SymmetrizedBrdf fitted(source.ref());
  const FigureOptions figures{.count = 5000, .image_size = 32};
  const NoiseScale scale(source, fitted, true, figures);
  ASSERT_TRUE(scale.noise());
  const Scorer scorer(fitted, figures);
  const ErrorFigures exchanged = exchanged_figures(scorer, source.ref()).value();
  EXPECT_LE(scale.noise()->relative, exchanged.relative);
  EXPECT_EQ(scale.noise()->rms, exchanged.rms);
  // The mean of |noise| is sqrt(2 / pi) of its size; interpolated values have less of it.
  EXPECT_NEAR(std::log1p(scale.noise()->relative), 0.6 * kNoise, 0.3 * kNoise);
  // The fitted function has no excess; the source itself has some.
  EXPECT_EQ(scale.excess(scale.error_of(fitted)), 0);
  EXPECT_GT(scale.excess(scale.error_of(source.ref())), 0.5);
  // Without symmetrization the noise is not known.
  EXPECT_FALSE(NoiseScale(source, source.ref(), false, figures).noise());
}

}  // namespace
}  // namespace burnish
