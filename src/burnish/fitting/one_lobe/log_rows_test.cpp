// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/one_lobe/log_rows.h>
#include <burnish/math/angles.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

constexpr double kRowFloor = 1e-4, kRowErrorFloor = 1e-3;

ModelSpec row_spec() {
  return parse_model_spec("p(wo) q(h) p(wi)", std::vector<std::string>{"p=5", "q=4x4"}, true);
}

/// These pairs, values of one channel and weights.
SampleSource listed(std::vector<DirectionPair> all, std::vector<double> f, std::vector<double> weight) {
  SampleSource source{
      .count = all.size(), .distinct = all.size(), .channels = 1, .isotropic = true, .fill = {}};
  source.fill = [all = std::move(all), f = std::move(f), weight = std::move(weight)](
                    std::size_t begin, std::span<DirectionPair> pairs, std::span<double> values,
                    std::span<double> weights) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      pairs[i] = all[begin + i];
      values[i] = f[begin + i];
      weights[i] = weight[begin + i];
    }
  };
  return source;
}

const DirectionPair kRowPair{{0.6, 0, 0.8}, {0, -0.6, 0.8}};

TEST(LogRows, AreOfWhatWeighsSomethingAboveTheHorizon) {
  const ModelSpec spec = row_spec();
  const SampleSource source =
      listed({kRowPair, {{0.6, 0, -0.8}, {0, 0, 1}}, kRowPair, {{0, 0, 1}, {1, 0, 0}}, kRowPair, kRowPair},
             {1, 1, 1, 1, 0, -5}, {2, 1, 0, 1, 3, 4});
  const LogRows rows = RowMaker(source, spec, kRowFloor, kRowErrorFloor).make(0, source.count);
  ASSERT_EQ(rows.size, 3u);
  EXPECT_EQ(rows.weight, (std::vector<float>{2, 3, 4}));
  ASSERT_EQ(rows.target.size(), 3u);
  EXPECT_FLOAT_EQ(rows.target[0], static_cast<float>(std::log1p(kRowFloor)));
  for (const std::size_t i : {1, 2}) EXPECT_FLOAT_EQ(rows.target[i], static_cast<float>(std::log(kRowFloor)));
  // lookups of each use in turn
  ASSERT_EQ(rows.node.size(), 3 * spec.lobes[0].size());
  for (std::size_t k = 0; k < spec.lobes[0].size(); ++k) {
    const FactorUse& use = spec.lobes[0][k];
    const Lookup expected = locate(spec.tables[use.table].layout, use, kRowPair.wi, kRowPair.wo);
    EXPECT_EQ(rows.node[k], static_cast<std::uint32_t>(expected.node));
    EXPECT_FLOAT_EQ(rows.fx[k], static_cast<float>(expected.fx));
    EXPECT_FLOAT_EQ(rows.fy[k], static_cast<float>(expected.fy));
  }
}

TEST(LogRows, WeighMoreTowardsBackscatterDownToASixtyFourth) {
  const ModelSpec spec = row_spec();
  constexpr double kBackscatter = 0.2;
  const auto weight_at = [&](double theta_d) {
    const SampleSource source =
        listed({{spherical_direction(0.5 + theta_d, 1), spherical_direction(0.5 - theta_d, 1)}}, {1}, {3});
    RowMaker maker(source, spec, kRowFloor, kRowErrorFloor);
    maker.backscatter = kBackscatter;
    return static_cast<double>(maker.make(0, 1).weight.at(0));
  };
  EXPECT_NEAR(weight_at(2 * kBackscatter), 3, 1e-6);
  EXPECT_NEAR(weight_at(kBackscatter / 4), 3 * 8, 1e-5);
  EXPECT_NEAR(weight_at(kBackscatter / 64), 3 * 512, 1e-3);
  EXPECT_NEAR(weight_at(0), 3 * 512, 1e-3);
}

// About a model, weight times the squared step is the weight times the error's size, and the step leads to it.
TEST(LogRows, StepsWeighAsAbsoluteErrorsDo) {
  const ModelSpec spec = row_spec();
  const FactoredBrdf model = random_model("p(wo) q(h) p(wi)", {"p=5", "q=4x4"}, 1, TableFormat::single);
  double m;
  model.eval(kRowPair.wi, kRowPair.wo, {&m, 1});
  for (const double factor : {0.1, 0.4, 2.0, 4.0}) {
    const SampleSource source = listed({kRowPair}, {factor * m}, {2});
    RowMaker maker(source, spec, kRowFloor, kRowErrorFloor);
    maker.current = &model;
    const LogRows rows = maker.make(0, 1);
    const double step = static_cast<double>(rows.target.at(0)) - std::log(m),
                 error = std::log((factor * m + kRowErrorFloor) / (m + kRowErrorFloor)),
                 slope = m / (m + kRowErrorFloor);
    ASSERT_GT(std::abs(error), 0.2);  // smaller ones count as squares
    EXPECT_NEAR(slope * step, error, 1e-5);
    EXPECT_NEAR(static_cast<double>(rows.weight.at(0)) * step * step, 2 * std::abs(error), 1e-4);
  }
}

}  // namespace
}  // namespace burnish
