// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/report/specular_figures.h>

namespace burnish {
namespace {

using M = PowerMethod;

TEST(SpecularFigures, LobesStartAtOneAndFallToAThousandth) {
  const M methods[] = {M::quadratic, M::w8};
  const double exponents[] = {10, 50};
  const Plot plot = lobe_figure(methods, exponents);
  ASSERT_EQ(plot.series.size(), 6u);
  for (const PlotSeries& series : plot.series) EXPECT_NEAR(series.y.front(), 1, 1e-12);
  EXPECT_NEAR(plot.series[0].y.back(), 1e-3, 1e-9);
}

TEST(SpecularFigures, LargestRelativeErrorsAreThePapers) {
  const M methods[] = {M::quadratic};
  const PlotSeries series = max_relative_error_figure(methods).series.at(0);
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    EXPECT_LE(series.y[i], 3.16);
    if (series.x[i] > 500) {
      EXPECT_GT(series.y[i], 3.1);
    }
  }
  EXPECT_GT(series.x.back(), 500);
}

TEST(SpecularFigures, RelativeErrorsVanishAtTheCentreAndTheInflection) {
  const M methods[] = {M::quadratic};
  const double exponents[] = {10};
  const PlotSeries series = relative_error_figure(methods, exponents).series.at(0);
  EXPECT_NEAR(series.y.front(), 0, 1e-10);
  const double inflection = std::atan(1 / 3.0) * 180 / 3.14159265358979;
  for (std::size_t i = 1; i < series.x.size(); ++i)
    if (series.x[i - 1] < inflection && series.x[i] >= inflection) {
      EXPECT_NEAR(series.y[i], 0, 0.5);
    }
}

TEST(SpecularFigures, CoefficientStaysBelowTheLineFromTwoOn) {
  const PlotSeries series = coefficient_figure().series.at(0);
  for (std::size_t i = 0; i < series.x.size(); ++i)
    if (series.x[i] >= 2) {
      EXPECT_LT(series.y[i], 0.15);
    }
}

TEST(SpecularFigures, SphereDifferencesAreGreyWhereTheMemberIsExact) {
  const M methods[] = {M::exact, M::quadratic};
  const SphereFigure figure = sphere_figure(methods, 20, 64);
  EXPECT_EQ(figure.image.width, 2 * 68);
  EXPECT_EQ(figure.image.height, 3 * 68);
  EXPECT_NEAR(figure.max_difference, max_absolute_error(M::quadratic, 20), 1e-12);
  int darkest = 255;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      EXPECT_NEAR(figure.image.at(x, 2 * 68 + y)[0], 127.5, 0.5);
      darkest = std::min<int>(darkest, figure.image.at(68 + x, 2 * 68 + y)[0]);
    }
  EXPECT_LE(darkest, 3);                            // the cut tail
  EXPECT_GE(figure.image.at(32, 68 + 32)[0], 254);  // the highlight's centre
}

TEST(SpecularFigures, RefuseEmptyListsAndSizes) {
  const double exponents[] = {10};
  const M methods[] = {M::cubic4};
  EXPECT_THROW(lobe_figure(methods, {}), Error);
  EXPECT_THROW(relative_error_figure({}, exponents), Error);
  EXPECT_THROW(sphere_figure({}, 10), Error);
  EXPECT_THROW(sphere_figure(methods, 10, 8), Error);
  EXPECT_THROW(sphere_figure(methods, 2), Error);  // outside the member's range
}

}  // namespace
}  // namespace burnish
