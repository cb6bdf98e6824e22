#include <algorithm>

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

}  // namespace
}  // namespace burnish
