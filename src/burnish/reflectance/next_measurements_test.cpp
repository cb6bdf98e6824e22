// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/next_measurements.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

constexpr std::size_t kRound = 20;

/// Mean |ln| of the ratio of a source and the function between its samples.
double error_of(BrdfRef source, const Samples& samples) {
  const MeasuredNodes nodes = measured_nodes(samples);
  const KrigedNodes function(nodes, choose_covariance(nodes));
  std::vector<double> f(source.channels()), g(source.channels());
  double sum = 0;
  std::size_t count = 0;
  for (const auto& [wi, wo] : draw_pairs(1000, 77, source.isotropic())) {
    if (std::min(wi.z, wo.z) < NodeScoring{}.least_cosine) continue;
    source.eval(wi, wo, f);
    function.eval(wi, wo, g);
    for (std::size_t c = 0; c < f.size(); ++c, ++count)
      sum += std::abs(std::log((f[c] + KrigedNodes::kFloor) / (g[c] + KrigedNodes::kFloor)));
  }
  return sum / static_cast<double>(count);
}

void add(Samples& samples, BrdfRef source, const DirectionPair& pair) {
  std::vector<double> f(source.channels());
  source.eval(pair.wi, pair.wo, f);
  samples.pairs.push_back(pair);
  samples.values.insert(samples.values.end(), f.begin(), f.end());
}

TEST(NextMeasurements, LowerErrorsMoreThanRandomOnes) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const fixtures::Glossy glossy{.a = 60, .b = 60}, sharp{.a = 200, .b = 200}, brushed{.a = 10, .b = 60};
  for (const BrdfRef source : {BrdfRef(glossy), BrdfRef(sharp), BrdfRef(brushed)}) {
    Samples chosen = measure(source, {.count = 100, .noise = 0});
    double of_random = 0;
    for (int draw = 1; draw <= 3; ++draw) {
      Samples random = measure(source, {.count = 100, .noise = 0});
      for (const DirectionPair& pair :
           draw_pairs(kRound, 500 + static_cast<std::uint64_t>(draw), source.isotropic()))
        add(random, source, pair);
      of_random += error_of(source, random) / 3;
    }
    const MeasuredNodes nodes = measured_nodes(chosen);
    for (const auto& [pair, error] : next_measurements(nodes, choose_covariance(nodes), kRound))
      add(chosen, source, pair);
    EXPECT_LT(error_of(source, chosen), of_random);
  }
}

// Light from near the normal alone was measured.
TEST(NextMeasurements, GoWhereNothingWasMeasured) {
  const fixtures::Glossy source{.a = 8, .b = 8};
  Samples samples{.channels = 3, .isotropic = true, .pairs = {}, .values = {}};
  for (int i = 0; i < 4; ++i)
    for (int o = 0; o < 40; ++o)
      add(samples, source,
          {spherical_direction(radians(5 * i), 0),
           spherical_direction(radians(8 * (o / 5)), kTwoPi * (o % 5) / 10)});
  const auto next = next_measurements(measured_nodes(samples), LogCovariance(true), 10);
  ASSERT_EQ(next.size(), 10u);
  std::size_t far = 0;
  for (const auto& [pair, error] : next) {
    EXPECT_GT(std::min(pair.wi.z, pair.wo.z), 0.149);
    EXPECT_NEAR(pair.wi.y, 0, 1e-12);
    EXPECT_GT(error, 0);
    far += std::min(theta_of(pair.wi), theta_of(pair.wo)) > radians(20);
  }
  EXPECT_GE(far, 7u);
  EXPECT_GT(next.front().error, next.back().error);
}

TEST(NextMeasurements, AreAllDifferentAndEndWithWhatIsTried) {
  const MeasuredNodes nodes = measured_nodes(measure(fixtures::Lambert{}, {.count = 60, .noise = 0.1}));
  const auto some = next_measurements(nodes, LogCovariance(true), 12);
  for (std::size_t i = 0; i < some.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(are_one_measurement(some[i].pair, some[j].pair, true)) << i << " " << j;
  EXPECT_TRUE(next_measurements(nodes, LogCovariance(true), 0).empty());
}

}  // namespace
}  // namespace burnish
