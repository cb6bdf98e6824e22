// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/one_lobe/normal_equations.h>
#include <burnish/testing/log_systems.h>

namespace burnish {
namespace {

constexpr double kDirectSmooth = 1e-3;

TEST(NormalEquations, EndWhereTheObjectiveIsLeast) {
  // More than are gathered at a time. The ridge is 1e-7 of the mean diagonal; a node's slope at 0 is about its diagonal
  // times its value, where the diagonals of the tables are within some ten times of their mean.
  fixtures::expect_least(
      6000, [](const RowMaker& rows) { return solve_normal_equations(rows, {.smooth = kDirectSmooth}); },
      kDirectSmooth, {.slope = 1e-5, .rms = 1e-6}, StopReason::direct_solution);
}

TEST(NormalEquations, TellTheErrorOfTheBestConstant) {
  // two samples of one pair: logarithms 0 and 3 with weights 1 and 2 have the mean 2 and the variance 2
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=3", "q=3"}, true);
  SampleSource source{.count = 2, .distinct = 2, .channels = 1, .isotropic = true, .fill = {}};
  source.fill = [](std::size_t begin, std::span<DirectionPair> pairs, std::span<double> values,
                   std::span<double> weights) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto k = static_cast<double>(begin + i);
      pairs[i] = {{0.6, 0, 0.8}, {0, 0.6, 0.8}};
      values[i] = std::exp(3 * k) - 1e-3;
      weights[i] = 1 + k;
    }
  };
  const LogSolution found = solve_normal_equations({source, spec, 1e-3, 1e-3}, {});
  EXPECT_NEAR(found.summary.error_before, std::sqrt(2), 1e-6);
  EXPECT_NEAR(found.summary.error_after, std::sqrt(2), 1e-6);
}

TEST(NormalEquations, RefuseSamplesWithoutWeight) {
  SampleSource source = fixtures::random_log_source(100, 1);
  source.fill = [fill = source.fill](std::size_t begin, std::span<DirectionPair> pairs,
                                     std::span<double> values, std::span<double> weights) {
    fill(begin, pairs, values, weights);
    std::ranges::fill(weights, 0.0);
  };
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=3", "q=3"}, true);
  EXPECT_THROW(solve_normal_equations({source, spec, 1e-3, 1e-3}, {}), Error);
}

}  // namespace
}  // namespace burnish
