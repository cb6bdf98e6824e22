#include <set>
#include <string>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

TEST(FitBaseline, TellsMethodBytesAndCost) {
  const testing::Glossy source;
  const SampleSource samples = from_brdf(source, 2000, 1, false);
  const BaselineFit dgf = fit_baseline(source, samples, "dgf", {.budget = 600});
  EXPECT_EQ(dgf.method, "dgf");
  EXPECT_EQ(dgf.bytes, baseline_bytes(dgf.baseline.brdf));
  EXPECT_LE(dgf.bytes, 600u);
  EXPECT_GT(dgf.seconds, 0);
  EXPECT_EQ(dgf.cost, evaluation_cost(dgf.baseline.brdf));
  const BaselineFit ward = fit_baseline(source, samples, "analytic:ward", {});
  EXPECT_EQ(ward.baseline.kind, "analytic");
  EXPECT_FALSE(ward.cost);
  EXPECT_EQ(fit_baseline(source, samples, "analytic:cook-torrance", {}).method, "analytic:cook_torrance");
}

TEST(FitBaseline, RefusesOtherMethods) {
  const testing::Glossy source;
  const SampleSource samples = from_brdf(source, 10, 1, false);
  for (const std::string_view method : {"", "pca", "analytic:", "analytic:satin", "svd "})
    EXPECT_THROW(fit_baseline(source, samples, method, {}), Error) << method;
}

}  // namespace
}  // namespace burnish
