// SPDX-License-Identifier: Apache-2.0
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

TEST(FitBaseline, TellsItsMethodAndKeepsToTheBudget) {
  const fixtures::Glossy source;
  const SampleSource samples = from_brdf(source, 2000, 1, false);
  const BaselineFit dgf = fit_baseline(source, samples, "dgf", {.budget = 600});
  EXPECT_EQ(dgf.method, "dgf");
  EXPECT_TRUE(std::holds_alternative<DgfBrdf>(dgf.brdf));
  EXPECT_LE(baseline_bytes(dgf.brdf), 600u);
  const BaselineFit ward = fit_baseline(source, samples, "analytic:ward", {});
  EXPECT_TRUE(std::holds_alternative<AnalyticBrdf>(ward.brdf));
  EXPECT_TRUE(ward.starts);
  EXPECT_EQ(fit_baseline(source, samples, "analytic:cook-torrance", {}).method, "analytic:cook_torrance");
}

TEST(FitBaseline, RefusesOtherMethods) {
  const fixtures::Glossy source;
  const SampleSource samples = from_brdf(source, 10, 1, false);
  for (const std::string_view method : {"", "pca", "analytic:", "analytic:satin", "svd "})
    EXPECT_THROW(fit_baseline(source, samples, method, {}), Error) << method;
}

}  // namespace
}  // namespace burnish
