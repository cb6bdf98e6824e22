// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/gathered_samples.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

TEST(GatherSamples, TakesThoseWithWeightEvenly) {
  const fixtures::Glossy source;
  const SampleSource all = from_brdf(source, 5000, 1, false);
  const GatheredSamples every = gather_samples(all, 5000), some = gather_samples(all, 500);
  EXPECT_GT(every.size(), 1000u);
  EXPECT_NEAR(static_cast<double>(some.size()), 0.1 * static_cast<double>(every.size()), 60);
  for (std::size_t i = 0; i < every.size(); ++i) {
    EXPECT_GT(every.weights[i], 0);
    EXPECT_GT(std::min(every.pairs[i].wi.z, every.pairs[i].wo.z), 0);
  }
  const fixtures::Glossy knows_nothing{.blind_below = 2};
  EXPECT_THROW(gather_samples(from_brdf(knows_nothing, 100, 1, false), 100), Error);
}

// Far above the mean an error counts relative to the value: twice f has a quarter of the weight. Twice all values, or
// other weights of all samples, leave the shares as they are.
TEST(GatherSamples, WeighErrorsAsPicturesShowThem) {
  GatheredSamples samples{.channels = 2, .pairs = {}, .values = {}, .weights = {}};
  for (const double f : {0.01, 1e3, 2e3})
    for (int i = 0; i < (f < 1 ? 5000 : 1); ++i) {
      samples.pairs.push_back({{0.6, 0, 0.8}, {0, 0.6, 0.8}});
      samples.values.insert(samples.values.end(), {7, f});
      samples.weights.push_back(f < 1 ? 2000 : 1);
    }
  const std::vector<double> weights = compressive_weights(samples, 1);
  ASSERT_EQ(weights.size(), samples.size());
  const std::size_t last = samples.size() - 1;
  // 1 / ((x + m / 100) (1 + 10 x / m)), x being 1e5 m or more: to 1e-6
  EXPECT_NEAR(weights[last - 1] / weights[last], 4, 1e-5);
  EXPECT_GT(weights[0], 1e6 * weights[last]);
  GatheredSamples others = samples;
  for (double& value : others.values) value *= 2;
  for (double& weight : others.weights) weight *= 3;
  const std::vector<double> scaled = compressive_weights(others, 1);
  for (const std::size_t i : {std::size_t{0}, last})
    EXPECT_NEAR(scaled[i] / weights[i], 3.0 / 2, 1e-12);  // of errors of f: 1 / x
}

}  // namespace
}  // namespace burnish
