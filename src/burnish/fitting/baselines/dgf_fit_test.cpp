// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/dgf_fit.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

template <class Value>
NodeTable table_of(PairCoordinate coordinate, int count, const Value& value) {
  NodeTable table{{{coordinate, count}}, 1, 1, {}};
  for (int i = 0; i < count; ++i) table.values.push_back(round_to_half(value(table.axes[0].node(i))));
  return table;
}

/// A satin microfacet model made of tables.
DgfBrdf satin(int size_d, int size_fg) {
  return DgfBrdf(
      {0.05f, 0.1f, 0.02f}, {2, 1, 3},
      table_of(PairCoordinate::theta_h, size_d, [](double u) { return std::exp(-20 * std::pow(u, 4)); }),
      table_of(PairCoordinate::theta_d, size_fg, [](double u) { return std::cos(kHalfPi * u * 0.99); }),
      table_of(PairCoordinate::theta_d, size_fg, [](double u) { return 0.3 + 0.7 * u * u * u; }));
}

TEST(FitDgf, RecoversAMicrofacetModelMadeOfTables) {
  const DgfBrdf truth = satin(32, 16);
  // as many nodes as the truth has: 2 (32 + 16 + 16) + 8 bytes a channel
  const DgfFit fit = fit_dgf(from_brdf(truth, 12'000, 1, false), {.budget = 3 * 136});
  EXPECT_EQ(fit.brdf.bytes(), 3u * 136);
  EXPECT_EQ(fit.brdf.d().axes[0].count, 32);
  EXPECT_LT(fit.summary.error_after, 0.01 * fit.summary.error_before);
  const ErrorFigures error = error_figures(truth, fit.brdf, {.count = 2000, .image_size = 64});
  EXPECT_LT(error.relative, 0.05);
  EXPECT_GT(error.psnr, 40);
}

TEST(FitDgf, GetsBetterWithItsBudgetUpToThePapersTables) {
  const fixtures::Glossy source{.a = 80, .b = 80};
  const SampleSource samples = from_brdf(source, 6'000, 1, false);
  const DgfFit small = fit_dgf(samples, {.budget = 200, .rounds = 30}),
               large = fit_dgf(samples, {.budget = 1000, .rounds = 30}),
               capped = fit_dgf(samples, {.budget = 1 << 20, .rounds = 1});
  EXPECT_LE(small.brdf.bytes(), 200u);
  EXPECT_LE(large.brdf.bytes(), 1000u);
  EXPECT_LT(large.summary.error_after, small.summary.error_after);
  EXPECT_EQ(capped.brdf.d().axes[0].count, 180);
  EXPECT_EQ(capped.brdf.g().axes[0].count, 90);
}

TEST(FitDgf, RefusesAnisotropicSourcesAndSmallBudgets) {
  const fixtures::Glossy brushed{.a = 80, .b = 8}, glossy;
  EXPECT_THROW(fit_dgf(from_brdf(brushed, 100, 1, false), {}), Error);
  EXPECT_THROW(fit_dgf(from_brdf(glossy, 100, 1, false), {.budget = 100}), Error);
}

}  // namespace
}  // namespace burnish
