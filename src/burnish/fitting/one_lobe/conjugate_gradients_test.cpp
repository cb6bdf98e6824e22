// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/one_lobe/conjugate_gradients.h>
#include <burnish/testing/log_systems.h>

namespace burnish {
namespace {

constexpr double kIteratedSmooth = 1e-3;

TEST(ConjugateGradients, EndWhereTheObjectiveIsLeast) {
  // sums of some thousand floats
  fixtures::expect_least(
      3000,
      [](const RowMaker& rows) {
        return solve_by_conjugate_gradients(
            rows, {.smooth = kIteratedSmooth, .max_iterations = 500, .tolerance = 1e-6});
      },
      kIteratedSmooth, {.slope = 1e-4, .rms = 1e-5}, StopReason::tolerance_reached);
}

TEST(ConjugateGradients, StopAtTheMostIterationsAndGoOnTowardsTheLeast) {
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=16", "q=32"}, true);
  const SampleSource source = fixtures::random_log_source(2000, 3);
  const RowMaker rows(source, spec, 1e-3, 1e-3);
  double before = 0;
  for (const int most : {1, 3, 10}) {
    double last = -1;
    const LogSolution found = solve_by_conjugate_gradients(
        rows, {.smooth = 1e-6, .max_iterations = most, .tolerance = 1e-9, .progress = [&](double fraction) {
                 EXPECT_LE(fraction, 1);
                 last = fraction;
               }});
    EXPECT_EQ(found.summary.iterations, most);
    EXPECT_EQ(found.summary.stop_reason, StopReason::iteration_limit);
    EXPECT_GE(last, 0);
    if (before > 0) {
      EXPECT_LT(found.summary.error_after, before);
    }
    before = found.summary.error_after;
  }
}

TEST(ConjugateGradients, RefuseSamplesWithoutWeight) {
  SampleSource source = fixtures::random_log_source(0, 3);
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=3x3", "q=3x3"}, true);
  EXPECT_THROW(solve_by_conjugate_gradients({source, spec, 1e-3, 1e-3}, {}), Error);
}

}  // namespace
}  // namespace burnish
