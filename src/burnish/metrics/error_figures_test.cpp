// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

using fixtures::Glossy;
using fixtures::Lambert;

constexpr FigureOptions kQuick{.count = 3000, .image_size = 48};

TEST(ErrorFigures, OfEqualBrdfsAreZeroInfiniteAndOne) {
  for (const double floor : {1e-3, 0.0}) {
    FigureOptions options = kQuick;
    options.floor = floor;
    const ErrorFigures figures = error_figures(Glossy{}, Glossy{}, options);
    EXPECT_EQ(figures.log_cos, 0);
    EXPECT_EQ(figures.relative, 0);
    EXPECT_EQ(figures.rms_log, 0);
    EXPECT_EQ(figures.mean_abs_log, 0);
    EXPECT_EQ(figures.psnr, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(figures.ssim, 1, 1e-12);
    EXPECT_EQ(figures.unknown_fraction, 0);
    EXPECT_EQ(figures.unknown_pixels, 0u);
  }
}

TEST(ErrorFigures, OfTwiceTheReferenceAreExactWithoutAFloor) {
  FigureOptions options = kQuick;
  options.floor = 0;
  for (const double scale : {2.0, 0.5}) {
    const ErrorFigures figures = error_figures(Glossy{}, Glossy{.scale = scale}, options);
    EXPECT_NEAR(figures.relative, 1, 1e-12);
    EXPECT_NEAR(figures.rms_log, std::log(2.0), 1e-12);
    EXPECT_NEAR(figures.mean_abs_log, std::log(2.0), 1e-12);
  }
}

TEST(ErrorFigures, FloorDampsDarkValues) {
  // two grey constants: every pair has the same ratio
  const Lambert dark{.albedo = {0.001 * kPi, 0, 0}, .count = 1};
  const Lambert twice{.albedo = {0.002 * kPi, 0, 0}, .count = 1};
  EXPECT_NEAR(error_figures(dark, twice, kQuick).relative, 3.0 / 2 - 1, 1e-12);
  EXPECT_NEAR(error_figures(dark, twice, kQuick).rms, 0.001, 1e-12);
}

TEST(ErrorFigures, LogCosWeighsByTheCosineOfTheLight) {
  const Lambert a{.albedo = {kPi, 0, 0}, .count = 1}, b{.albedo = {2 * kPi, 0, 0}, .count = 1};
  const Scorer scorer(a, kQuick);
  double sum = 0;
  const auto errors = scorer.pair_errors(b);
  for (const PairError& error : errors) {
    const double cosine = error.pair.wi.z;
    EXPECT_NEAR(error.log_cos, std::log((1 + 2 * cosine) / (1 + cosine)), 1e-12);
    sum += std::log((1 + 2 * cosine) / (1 + cosine));
  }
  EXPECT_NEAR(scorer.score(b).log_cos, sum / static_cast<double>(errors.size()), 1e-12);
}

TEST(ErrorFigures, PsnrIsThatOfTheMeanErrorOfTheThreeSpheres) {
  const Scorer scorer(Glossy{}, kQuick);
  const Glossy model{.scale = 0.7};
  const SpherePictures shown = scorer.pictures(model);
  double squared = 0, similarity = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    squared += mean_squared_error(scorer.reference_pictures().shown[i], shown.shown[i]) / 3;
    similarity += ssim(scorer.reference_pictures().shown[i], shown.shown[i]) / 3;
  }
  const ErrorFigures figures = scorer.score(model);
  EXPECT_NEAR(figures.psnr, -10 * std::log10(squared), 1e-9);
  EXPECT_NEAR(figures.ssim, similarity, 1e-12);
  EXPECT_GT(figures.psnr, 10);
  EXPECT_LT(figures.psnr, 40);
}

TEST(ErrorFigures, DoNotDependOnTheNumberOfThreads) {
  const auto figures = [](int threads) {
    const ThreadLimit limit(threads);
    return error_figures(Glossy{}, Glossy{.a = 30, .b = 50}, kQuick);
  };
  const ErrorFigures one = figures(1), many = figures(4);
  EXPECT_EQ(one.log_cos, many.log_cos);
  EXPECT_EQ(one.relative, many.relative);
  EXPECT_EQ(one.rms_log, many.rms_log);
  EXPECT_EQ(one.mean_abs_log, many.mean_abs_log);
  EXPECT_EQ(one.psnr, many.psnr);
  EXPECT_EQ(one.ssim, many.ssim);
}

TEST(ErrorFigures, UnknownPairsAreSkippedAndCounted) {
  const Glossy whole, holed{.blind_below = 0.5};
  const std::vector<DirectionPair> pairs = [&] {
    std::vector<DirectionPair> all;
    for (const PairError& error : Scorer(whole, kQuick).pair_errors(whole)) all.push_back(error.pair);
    return all;
  }();
  const auto blind = std::ranges::count_if(
      pairs, [](const DirectionPair& p) { return dot(p.wi, half_vector(p.wi, p.wo)) < 0.5; });
  ASSERT_GT(blind, 100);
  const double expected = static_cast<double>(blind) / static_cast<double>(kQuick.count);
  for (const ErrorFigures& figures :
       {error_figures(whole, holed, kQuick), error_figures(holed, whole, kQuick)}) {
    EXPECT_NEAR(figures.unknown_fraction, expected, 1e-12);
    EXPECT_EQ(figures.relative, 0);
  }
}

TEST(ErrorFigures, PixelsTheReferenceDoesNotKnowAreNotHeldAgainstTheModel) {
  // theta_d is 15 degrees under the second light and 30 under the third, which is hidden from the reference
  const Glossy whole, holed{.blind_below = std::cos(radians(20))};
  const ErrorFigures forgiven = error_figures(holed, whole, kQuick);
  EXPECT_EQ(forgiven.psnr, std::numeric_limits<double>::infinity());
  EXPECT_GT(forgiven.unknown_pixels, 500u);
  const ErrorFigures blamed = error_figures(whole, holed, kQuick);
  EXPECT_LT(blamed.psnr, 20);
  EXPECT_EQ(blamed.unknown_pixels, 0u);
}

TEST(ErrorFigures, AnAnisotropicModelOfAnIsotropicReferenceIsSeenFromAllSides) {
  // along phi_h = 0 alone this model looks perfect
  const Glossy reference{.a = 40, .b = 40}, model{.a = 40, .b = 4};
  EXPECT_GT(error_figures(reference, model, kQuick).relative, 0.1);
}

TEST(ErrorFigures, GreyStandsForEveryChannel) {
  const Lambert grey{.albedo = {0.4, 0, 0}, .count = 1}, colour{.albedo = {0.4, 0.4, 0.4}};
  EXPECT_EQ(error_figures(grey, colour, kQuick).relative, 0);
  EXPECT_EQ(error_figures(colour, grey, kQuick).log_cos, 0);
  EXPECT_EQ(error_figures(colour, grey, kQuick).psnr, std::numeric_limits<double>::infinity());
}

TEST(ErrorFigures, RefuseWhatCannotBeCompared) {
  const Glossy two{.count = 2}, three{.count = 3};
  EXPECT_THROW(error_figures(two, three, kQuick), Error);
  const Glossy blind{.blind_below = 2};
  EXPECT_THROW(error_figures(blind, three, kQuick), Error);
  EXPECT_THROW(Scorer(three, {.count = 0}), Error);
  EXPECT_THROW(Scorer(three, {.floor = std::nan("")}), Error);
}

}  // namespace
}  // namespace burnish
