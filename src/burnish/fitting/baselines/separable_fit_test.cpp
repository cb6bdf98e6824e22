// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/negative_lobes.h>
#include <burnish/fitting/baselines/separable_fit.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/baselines.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

using fixtures::random_separable;
using enum PairCoordinate;

/// A grid without holes whose matrices have a given rank in every channel, coupled or not.
PairGrid grid_of(const SeparableBrdf& brdf) {
  PairGrid grid{.row_axes = brdf.u().axes,
                .column_axes = brdf.v().axes,
                .rows = brdf.u().node_count(),
                .columns = brdf.v().node_count(),
                .channels = 3,
                .values = {},
                .measured = {}};
  const auto terms = static_cast<std::size_t>(brdf.u().terms);
  for (std::size_t r = 0; r < grid.rows; ++r)
    for (std::size_t c = 0; c < grid.columns; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        double sum = 0;
        for (std::size_t t = 0; t < terms; ++t)
          sum += brdf.u().values[(r * 3 + k) * terms + t] * brdf.v().values[c * terms + t];
        grid.values.push_back(brdf.scale()[k] * sum);
      }
      grid.measured.push_back(1);
    }
  return grid;
}

double distance(const SeparableBrdf& a, const SeparableBrdf& b) {
  std::vector<double> fa(3), fb(3);
  double sum = 0, scale = 0;
  for (const auto& [wi, wo] : draw_pairs(2000, 1, true)) {
    a.eval(wi, wo, fa);
    b.eval(wi, wo, fb);
    for (std::size_t c = 0; c < 3; ++c) {
      sum += std::abs(fa[c] - fb[c]);
      scale += fb[c];
    }
  }
  return sum / scale;
}

TEST(Decompose, SvdRecoversABrdfOfItsRank) {
  const SeparableBrdf truth = random_separable(2, 0.1);
  const PairGrid grid = grid_of(truth);
  // half floats round by 2^-11 at most, a product of two by 2^-10, more where terms cancel
  EXPECT_LT(distance(decompose(grid, Decomposition::svd, Coupling::none, 2), truth), 2e-3);
  EXPECT_LT(distance(decompose(grid, Decomposition::svd, Coupling::v, 2), truth), 2e-3);
  EXPECT_GT(distance(decompose(grid, Decomposition::svd, Coupling::none, 1), truth), 1e-2);
}

TEST(Decompose, EveryMethodRecoversAProduct) {
  const SeparableBrdf truth = random_separable(1, 0.1);
  for (const Decomposition method : {Decomposition::svd, Decomposition::nd, Decomposition::nmf})
    for (const Coupling coupling : {Coupling::none, Coupling::v}) {
      const SeparableBrdf found = decompose(grid_of(truth), method, coupling, 1);
      EXPECT_LT(distance(found, truth), 2e-3) << to_string(method);
      EXPECT_EQ(found.v().channels, coupling == Coupling::v ? 1 : 3);
    }
}

TEST(Decompose, NmfHasNoNegativeTables) {
  const SeparableBrdf found = decompose(grid_of(random_separable(3, 0)), Decomposition::nmf, Coupling::u, 2);
  EXPECT_EQ(found.u().channels, 1);
  for (const NodeTable* table : {&found.u(), &found.v()})
    for (const float value : table->values) EXPECT_GE(value, 0);
}

TEST(Decompose, ErrorFallsWithEveryTerm) {
  const SeparableBrdf truth = random_separable(4, 0);
  const PairGrid grid = grid_of(truth);
  double last = 1;
  for (const std::size_t terms : {1u, 2u, 3u, 4u}) {
    const double error = distance(decompose(grid, Decomposition::svd, Coupling::none, terms), truth);
    EXPECT_LT(error, last);
    last = error;
  }
  EXPECT_LT(last, 5e-3);
}

TEST(FitSeparable, KeepsItsBudgetAndGetsBetterWithIt) {
  const fixtures::Glossy source{.a = 60, .b = 60};
  const Scorer scorer(source, {.count = 2000, .image_size = 32});
  for (const Decomposition method : {Decomposition::svd, Decomposition::nd, Decomposition::nmf}) {
    std::map<std::size_t, double> psnr;
    for (const std::size_t budget : {400u, 4000u}) {
      const SeparableFit fit = fit_separable(source, method, {.budget = budget, .image_size = 16});
      EXPECT_LE(fit.brdf.bytes(), budget);
      EXPECT_TRUE(fit.brdf.isotropic());
      EXPECT_EQ(method == Decomposition::nd,
                fit.brdf.u().terms == 1 && method != Decomposition::svd && method != Decomposition::nmf);
      psnr[budget] = scorer.score(fit.brdf).psnr;
    }
    // one term holds only so much, however fine its tables
    EXPECT_GT(psnr[4000], psnr[400] + (method == Decomposition::nd ? -0.5 : 3)) << to_string(method);
    EXPECT_GT(psnr[4000], 35) << to_string(method);
  }
}

TEST(FitSeparable, TakesAnisotropicAndGreySources) {
  const fixtures::Glossy brushed{.a = 60, .b = 6};
  const SeparableFit fit = fit_separable(brushed, Decomposition::svd, {.budget = 4000, .image_size = 16});
  EXPECT_LE(fit.brdf.bytes(), 4000u);
  EXPECT_FALSE(fit.brdf.isotropic());
  EXPECT_GT(error_figures(brushed, fit.brdf, {.count = 2000, .image_size = 32}).psnr, 25);
  const fixtures::Glossy grey{.count = 1};
  const SeparableFit one = fit_separable(grey, Decomposition::nmf, {.budget = 600, .image_size = 16});
  EXPECT_EQ(one.brdf.channels(), 1);
  EXPECT_LE(one.brdf.bytes(), 600u);
}

TEST(FitSeparable, KeepsTheSideOfPhiDWhereTheSourceTellsIt) {
  const auto whole = [](const SeparableBrdf& brdf) {
    for (const NodeTable* table : {&brdf.u(), &brdf.v()})
      for (const NodeAxis& axis : table->axes)
        if (axis.coordinate == half_turn_d) return true;
    return false;
  };
  const fixtures::Glossy even{.count = 1};
  const fixtures::Twisted twisted{.even = even, .slope = 2};
  const SeparableFit fit = fit_separable(twisted, Decomposition::svd, {.budget = 1500, .image_size = 16});
  EXPECT_LE(fit.brdf.bytes(), 1500u);
  EXPECT_TRUE(whole(fit.brdf) && fit.brdf.isotropic());
  EXPECT_LT(error_figures(twisted, fit.brdf, {.count = 2000, .image_size = 16}).relative, 0.1);
  EXPECT_FALSE(whole(fit_separable(even, Decomposition::svd, {.budget = 1500, .image_size = 16}).brdf));
}

TEST(FitSeparable, RefusesABudgetThatHoldsNothing) {
  const fixtures::Glossy source;
  EXPECT_THROW(fit_separable(source, Decomposition::svd, {.budget = 20, .image_size = 16}), Error);
}

TEST(NegativeLobes, AreFoundAndCostWhatTheyCost) {
  const fixtures::Glossy source{.a = 60, .b = 60};
  const Scorer scorer(source, {.count = 2000, .image_size = 32});
  // one term of both signs, negative in half of its places
  NodeTable u{{{theta_h, 2}}, 1, 1, {1, -1}}, v{{{theta_d, 2}}, 1, 1, {1, 1}};
  const NegativeLobes lobes = negative_lobes(SeparableBrdf(u, v, {1, 1, 1}), scorer);
  EXPECT_GT(lobes.negative_share, 0.5);  // sqrt(theta_h / (pi/2)) > 1/2 for three quarters of theta_h
  EXPECT_GT(lobes.bias, 1);
  EXPECT_NE(lobes.biased.relative, lobes.sum_clamped.relative);
  u.values = {1, 0.5f};
  const NegativeLobes none = negative_lobes(SeparableBrdf(u, v, {1, 1, 1}), scorer);
  EXPECT_EQ(none.negative_share, 0);
  EXPECT_EQ(none.bias, 0);
  EXPECT_EQ(none.biased.relative, none.sum_clamped.relative);
  EXPECT_EQ(none.tables_clamped.psnr, none.sum_clamped.psnr);
}

}  // namespace
}  // namespace burnish
