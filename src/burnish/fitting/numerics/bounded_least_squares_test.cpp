// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/numerics/bounded_least_squares.h>

namespace burnish {
namespace {

// Rosenbrock's valley as two functions of two unknowns; least, 0, at (1, 1).
LeastSquaresProblem rosenbrock(std::vector<double> lower, std::vector<double> upper) {
  const auto evaluate = [](auto x, auto values, auto slopes) {
    values[0] = 10 * (x[1] - x[0] * x[0]);
    values[1] = 1 - x[0];
    if (slopes.empty()) return;
    slopes[0] = -20 * x[0];
    slopes[1] = 10;
    slopes[2] = -1;
    slopes[3] = 0;
  };
  return {.functions = 2, .evaluate = evaluate, .lower = std::move(lower), .upper = std::move(upper)};
}

TEST(LeastSquares, FollowsAValleyToItsEnd) {
  const LeastSquaresSolution found = solve_least_squares(rosenbrock({-5, -5}, {5, 5}), {-1.2, 1}, {});
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 1, 1e-6);
  EXPECT_NEAR(found.x[1], 1, 1e-6);
  EXPECT_DOUBLE_EQ(found.first_cost, (4.4 * 4.4 + 2.2 * 2.2) / 2);
}

// Beyond x = 0.5 the sum would fall further; on the bound it is least at y = x^2.
TEST(LeastSquares, StopsAtABoundAndGoesOnAlongIt) {
  const LeastSquaresSolution found = solve_least_squares(rosenbrock({-5, -5}, {0.5, 5}), {-1.2, 1}, {});
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.x[0], 0.5);
  EXPECT_NEAR(found.x[1], 0.25, 1e-6);
  EXPECT_NEAR(found.cost, 0.125, 1e-9);
}

TEST(LeastSquares, LeavesABoundThatTheStartIsOn) {
  const LeastSquaresSolution found = solve_least_squares(rosenbrock({-2, -2}, {2, 2}), {-2, -9}, {});
  EXPECT_NEAR(found.x[0], 1, 1e-5);
  EXPECT_NEAR(found.x[1], 1, 1e-5);
}

// A linear problem with bounds is convex: where it ends, the slope of the sum points into the bounds or is 0.
TEST(LeastSquares, SolvesLinearProblemsWithinBounds) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  constexpr std::size_t kFunctions = 40, kUnknowns = 6;
  for (int round = 0; round < 50; ++round) {
    std::vector<double> matrix(kFunctions * kUnknowns), right(kFunctions);
    for (double& m : matrix) m = normal(random);
    for (double& r : right) r = 3 * normal(random);
    const auto evaluate = [&](auto x, auto values, auto slopes) {
      for (std::size_t i = 0; i < kFunctions; ++i) {
        values[i] = -right[i];
        for (std::size_t k = 0; k < kUnknowns; ++k) values[i] += matrix[i * kUnknowns + k] * x[k];
      }
      if (!slopes.empty()) std::copy(matrix.begin(), matrix.end(), slopes.begin());
    };
    const LeastSquaresSolution found =
        solve_least_squares({.functions = kFunctions,
                             .evaluate = evaluate,
                             .lower = std::vector<double>(kUnknowns, -0.2),
                             .upper = std::vector<double>(kUnknowns, 0.3)},
                            std::vector<double>(kUnknowns, 0.0), {.max_iterations = 100, .tolerance = 1e-12});
    EXPECT_TRUE(found.converged);
    std::vector<double> values(kFunctions);
    evaluate(found.x, values, std::span<double>{});
    for (std::size_t k = 0; k < kUnknowns; ++k) {
      double slope = 0;
      for (std::size_t i = 0; i < kFunctions; ++i) slope += matrix[i * kUnknowns + k] * values[i];
      EXPECT_TRUE(found.x[k] == -0.2 || slope < 1e-3) << round;
      EXPECT_TRUE(found.x[k] == 0.3 || slope > -1e-3) << round;
    }
  }
}

TEST(LeastSquares, RefusesAStartWithoutValues) {
  const auto nowhere = [](auto, auto values, auto) { values[0] = NAN; };
  EXPECT_THROW(
      solve_least_squares({.functions = 1, .evaluate = nowhere, .lower = {0}, .upper = {1}}, {0.5}, {}),
      Error);
}

}  // namespace
}  // namespace burnish
