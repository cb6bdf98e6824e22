// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/reflectance/expected_error.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

KrigedNodes kriged_from(BrdfRef source, std::size_t count, double noise) {
  const MeasuredNodes nodes = measured_nodes(measure(source, {.count = count, .noise = noise}));
  return {nodes, BURNISH_SANITIZED ? LogCovariance(nodes.samples.isotropic) : choose_covariance(nodes)};
}

double error_of(BrdfRef source, BrdfRef model) {
  const MeasuredNodes others = measured_nodes(measure(source, {.count = 4000, .seed = 5}));
  return node_figures(others, model).relative;
}

TEST(ExpectedError, IsAboutTheErrorOfTheFunctionItself) {
  BURNISH_SKIP_WHERE_SANITIZED();
  for (const double a : {8.0, 100.0})
    for (const std::size_t count : {200, 2000}) {
      const fixtures::Glossy source{.a = a, .b = a};
      const KrigedNodes function = kriged_from(source, count, 0.1);
      const double expected = expected_error(function, function).relative, found = error_of(source, function);
      EXPECT_GT(expected, 0.6 * found) << a << " " << count;
      EXPECT_LT(expected, 1.6 * found) << a << " " << count;
    }
}

TEST(ExpectedError, CountsWhatAModelIsOff) {
  const fixtures::Glossy source{.a = 8, .b = 8}, twice{.a = 8, .b = 8, .scale = 2};
  const KrigedNodes function = kriged_from(source, 600, 0);
  const ExpectedError off = expected_error(function, twice);
  EXPECT_NEAR(off.relative, 1, 0.1);
  for (const auto& band : off.by_theta_i) {
    ASSERT_TRUE(band);
    EXPECT_NEAR(*band, 1, 0.2);
  }
}

// Light from near the normal was measured.
TEST(ExpectedError, GrowsWhereNothingWasMeasured) {
  const fixtures::Glossy source{.a = 8, .b = 8};
  Samples samples{.channels = 3, .isotropic = true, .pairs = {}, .values = {}};
  std::vector<double> f(3);
  for (const auto& [wi, wo] : draw_pairs(2000, 4, true)) {
    if (wi.z < 0.9 && wo.z < 0.9) continue;
    source.eval(wi, wo, f);
    samples.pairs.push_back({wi, wo});
    samples.values.insert(samples.values.end(), f.begin(), f.end());
  }
  const KrigedNodes function(measured_nodes(samples), LogCovariance(true));
  const ExpectedError expected = expected_error(function, source);
  ASSERT_TRUE(expected.by_theta_i[0] && expected.by_theta_i[4]);
  EXPECT_GT(*expected.by_theta_i[4], 3 * *expected.by_theta_i[0]);
}

TEST(ExpectedError, TakesOneChannelForEachOfTheOthers) {
  const fixtures::Glossy source, grey{.count = 1}, two{.count = 2};
  const KrigedNodes function = kriged_from(source, 50, 0), of_grey = kriged_from(grey, 50, 0);
  const double equal = expected_error(function, source).relative;
  EXPECT_NE(expected_error(function, grey).relative, equal);  // the channels of the source differ
  EXPECT_GT(expected_error(of_grey, source).relative, expected_error(of_grey, grey).relative);
  EXPECT_THROW(expected_error(function, two), Error);
}

}  // namespace
}  // namespace burnish
