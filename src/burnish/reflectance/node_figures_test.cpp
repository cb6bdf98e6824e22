// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

const LogCovariance kDefault = LogCovariance(true);

MeasuredNodes nodes_of_source(BrdfRef source, std::size_t count, double noise = 0) {
  return measured_nodes(measure(source, {.count = count, .noise = noise}));
}

TEST(NodeFigures, AreZeroForTheSourceAndTheirDefinitionForOthers) {
  const fixtures::Glossy source, twice{.scale = 2};
  const MeasuredNodes nodes = nodes_of_source(source, 2000);
  const NodeFigures same = node_figures(nodes, source);
  EXPECT_EQ(same.relative, 0);
  EXPECT_EQ(same.rms, 0);

  // by hand
  double log_ratio = 0, log_cos = 0, squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto [wi, wo] = nodes.samples.pairs[i];
    if (std::min(wi.z, wo.z) <= 0.15) continue;
    ++count;
    for (const double f : nodes.samples.at(i)) {
      log_ratio += std::log((2 * f + 1e-3) / (f + 1e-3)) / 3;
      log_cos += (std::log1p(2 * f * wi.z) - std::log1p(f * wi.z)) / 3;
      squares += f * f / 3;
    }
  }
  const NodeFigures figures = node_figures(nodes, twice);
  const double n = static_cast<double>(count);
  EXPECT_EQ(figures.count, count);
  EXPECT_NEAR(figures.relative, std::expm1(log_ratio / n), 1e-9);
  EXPECT_NEAR(figures.log_cos, log_cos / n, 1e-9);
  EXPECT_NEAR(figures.rms, std::sqrt(squares / n), 1e-9);
  EXPECT_EQ(node_errors(nodes, twice).size(), count);
}

TEST(NodeFigures, CountNegativeValuesAsZeroAndNodesByTheirWeights) {
  Samples samples{.channels = 1, .isotropic = true};
  samples.pairs = {{spherical_direction(0.2, 0), spherical_direction(0.4, 1)},
                   {spherical_direction(0.3, 0), spherical_direction(0.5, 2)}};
  samples.values = {-1, 1};
  MeasuredNodes nodes = measured_nodes(samples);
  nodes.weights = {3, 1};
  const fixtures::Lambert black{.albedo = {0, 0, 0}, .count = 1};
  EXPECT_NEAR(node_figures(nodes, black).rms, 0.5, 1e-12);  // one of four parts is off by 1
}

TEST(NodeFigures, RefuseWhatCannotBeScored) {
  const MeasuredNodes nodes = nodes_of_source(fixtures::Glossy{}, 100);
  EXPECT_THROW(node_figures(nodes, fixtures::Lambert{.count = 2}), Error);
  EXPECT_THROW(node_figures(nodes, fixtures::Glossy{}, {.least_cosine = 1}), Error);
}

TEST(NodeFigures, CovarianceKnowsTheNoiseOfNodes) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const fixtures::Glossy source{.a = 8, .b = 8};
  const MeasuredNodes clean = nodes_of_source(source, 1500), noisy = nodes_of_source(source, 1500, 0.25);
  const LogCovariance of_clean = choose_covariance(clean), of_noisy = choose_covariance(noisy);
  EXPECT_LT(of_clean.noise, 0.1);
  EXPECT_NEAR(of_noisy.noise, 0.25, 0.05);
  // mean |error| of a perfect prediction is 0.25 sqrt(2 / pi)
  const double held_out = std::log1p(held_out_figures(noisy, of_noisy).relative);
  EXPECT_GT(held_out, 0.18);
  EXPECT_LT(held_out, 0.26);
}

TEST(NodeFigures, HeldOutFeelNeitherRoundingNorTheOrder) {
  // a grid of angles: some look back, some at the mirror direction
  const fixtures::Glossy source{.a = 8, .b = 8};
  Samples samples{.channels = 3, .isotropic = true}, others = samples;
  std::vector<double> f(3);
  for (int i = 0; i < 5; ++i)
    for (int o = 0; o < 60; ++o) {
      samples.pairs.push_back({spherical_direction(radians(15 * i), 0),
                               spherical_direction(radians(15 * (o / 12)), kTwoPi * (o % 12) / 12)});
      source.eval(samples.pairs.back().wi, samples.pairs.back().wo, f);
      samples.values.insert(samples.values.end(), f.begin(), f.end());
    }
  Pcg32 random(5);
  for (std::size_t i = samples.size(); i-- > 0;) {
    DirectionPair pair = samples.pairs[i];
    for (double* x : {&pair.wi.x, &pair.wi.y, &pair.wo.x, &pair.wo.y}) *x += 3e-16 * (random.uniform() - 0.5);
    others.pairs.push_back(pair);
    others.values.insert(others.values.end(), samples.at(i).begin(), samples.at(i).end());
  }
  const NodeFigures a = held_out_figures(measured_nodes(samples), kDefault),
                    b = held_out_figures(measured_nodes(others), kDefault);
  EXPECT_GT(a.relative, 1e-3);
  EXPECT_EQ(a.count, b.count);
  EXPECT_NEAR(b.relative / a.relative, 1, 1e-3);
  EXPECT_NEAR(b.log_cos / a.log_cos, 1, 1e-3);
}

TEST(NodeFigures, IncidencesAreHeldOutWhereThereAreFew) {
  const fixtures::Glossy source{.a = 8, .b = 8};
  Samples samples{.channels = 3, .isotropic = true};
  std::vector<double> f(3);
  const auto add = [&](int incidences) {
    for (int i = 0; i < incidences; ++i)
      for (int o = 0; o < 200; ++o) {
        const DirectionPair pair{spherical_direction(radians(70.0 * i / incidences), 0),
                                 spherical_direction(radians(7 * (o / 20) + 1), kTwoPi * (o % 20) / 20)};
        source.eval(pair.wi, pair.wo, f);
        samples.pairs.push_back(pair);
        samples.values.insert(samples.values.end(), f.begin(), f.end());
      }
  };
  add(7);
  const MeasuredNodes few = measured_nodes(samples);
  const auto between = held_out_incidences(few, kDefault);
  ASSERT_TRUE(between);
  EXPECT_EQ(between->count, 5 * 200u);  // the first and the last are always seen
  // nodes between those of one incidence are nearer
  EXPECT_LT(held_out_figures(few, kDefault).relative, between->relative);
  EXPECT_LT(between->relative, 0.1);

  EXPECT_FALSE(held_out_incidences(nodes_of_source(source, 500), kDefault));  // as many as samples
  samples = {.channels = 3, .isotropic = true};
  add(4);
  EXPECT_FALSE(held_out_incidences(measured_nodes(samples), kDefault));
}

}  // namespace
}  // namespace burnish
