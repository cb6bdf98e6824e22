#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/one_lobe/normal_equations.h>
#include <burnish/testing/log_systems.h>

namespace burnish {
namespace {

constexpr double kDirectSmooth = 1e-3;

TEST(NormalEquations, EndWhereTheObjectiveIsLeast) {
  for (const auto& [expression, tables, channels] : fixtures::kLogCases) {
    const ModelSpec spec = parse_model_spec(expression, tables, true);
    const SampleSource source =
        fixtures::random_log_source(6000, channels);  // more than are gathered at a time
    const RowMaker rows(source, spec, 1e-3, 1e-3);
    const LogSolution found = solve_normal_equations(rows, {.smooth = kDirectSmooth});
    EXPECT_EQ(found.samples, rows.make(0, source.count).size);
    EXPECT_EQ(found.summary.stop_reason, StopReason::direct_solution);
    const fixtures::LogObjective at = fixtures::log_objective(rows, found, kDirectSmooth);
    // the ridge is 1e-7 of the mean diagonal; a node's slope at 0 is about its diagonal times its value, where the
    // diagonals of the tables are within some ten times of their mean
    EXPECT_LT(fixtures::largest(at.slope), 1e-5 * fixtures::largest(at.slope_at_zero)) << expression;
    EXPECT_NEAR(found.summary.error_after, at.rms, 1e-6 * at.rms) << expression;
    EXPECT_LT(found.summary.error_after, found.summary.error_before) << expression;
  }
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
