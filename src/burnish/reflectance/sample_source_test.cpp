// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {
namespace {

struct Filled {
  std::vector<DirectionPair> pairs;
  std::vector<double> values, weights;
};

Filled fill(const SampleSource& source, std::size_t begin, std::size_t count) {
  const auto channels = source.channels;
  Filled result{std::vector<DirectionPair>(count), std::vector<double>(count * channels),
                std::vector<double>(count)};
  source.fill(begin, result.pairs, result.values, result.weights);
  return result;
}

TEST(SampleSource, ScatteredSamplesComeOnceInEachDirection) {
  Samples samples{.channels = 1, .isotropic = true};
  samples.pairs = {{{0, 0, 1}, normalize({1, 0, 1})}, {normalize({0, 1, 2}), {0, 0, 1}}};
  samples.values = {3, 4};
  const SampleSource source = from_samples(samples, true);
  ASSERT_EQ(source.count, 4u);
  const Filled all = fill(source, 0, 4);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(all.pairs[i], samples.pairs[i]);
    EXPECT_EQ(all.pairs[i + 2], (DirectionPair{samples.pairs[i].wo, samples.pairs[i].wi}));
    EXPECT_EQ(all.values[i], all.values[i + 2]);
  }
}

TEST(SampleSource, DrawnSamplesAreTheBrdfsValuesWhereverFillingStarts) {
  const AnalyticBrdf brdf = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.5");
  const SampleSource source = from_brdf(brdf, 1000, 3, false);
  const Filled all = fill(source, 0, 1000), part = fill(source, 700, 100);
  std::array<double, 3> f;
  bool turned = false;
  for (std::size_t i = 0; i < 1000; ++i) {
    const auto [wi, wo] = all.pairs[i];
    EXPECT_EQ(all.weights[i] > 0, wi.z > 0 && wo.z > 0);
    brdf.eval(wi, wo, f);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(all.values[3 * i + c], f[c]);
    turned = turned || std::abs(half_vector(wi, wo).y) > 0.1;
  }
  EXPECT_TRUE(turned);  // anisotropic: phi_h varies
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(part.pairs[i], all.pairs[700 + i]);
}

TEST(SampleSource, TableEntriesAreTheTablesValues) {
  const AnalyticBrdf brdf = parse_analytic("ashikhmin_shirley:exponent_x=20,exponent_y=20");
  ASSERT_TRUE(brdf.isotropic());
  for (const bool full : {false, true}) {
    const HalfDiffTable table = tabulate_half_diff(brdf, 12, 10, 16, full);
    for (const bool spread : {false, true}) {
      const SampleSource source = from_table(table, true, spread);
      ASSERT_EQ(source.count, table.entry_count());
      const Filled all = fill(source, 0, source.count);
      std::array<double, 3> f;
      std::size_t with_weight = 0;
      for (std::size_t i = 0; i < source.count; ++i) {
        if (!(all.weights[i] > 0)) continue;
        ++with_weight;
        const auto [wi, wo] = all.pairs[i];
        EXPECT_NEAR(length(wi), 1, 1e-12);
        EXPECT_NEAR(length(wo), 1, 1e-12);
        brdf.eval(wi, wo, f);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(all.values[3 * i + c], f[c], 1e-5 * f[c]);
      }
      EXPECT_GT(with_weight, source.count / 3);
    }
  }
}

}  // namespace
}  // namespace burnish
