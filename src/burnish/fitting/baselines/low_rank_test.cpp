// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/fitting/baselines/low_rank.h>
#include <burnish/testing/matrices.h>

namespace burnish {
namespace {

using fixtures::random_matrix;
using fixtures::sum_of_squares;

TEST(SingularValues, RecoverAMatrixOfTheirRank) {
  for (const auto& [rows, columns] : {std::pair{30, 12}, {12, 30}, {5, 5}}) {
    const Matrix m =
        random_matrix(static_cast<std::size_t>(rows), static_cast<std::size_t>(columns), 3, -1, 1);
    EXPECT_LT(squared_error(m, singular_values(m, 3)), 1e-14 * sum_of_squares(m));
    EXPECT_GT(squared_error(m, singular_values(m, 2)), 1e-4 * sum_of_squares(m));
  }
}

TEST(SingularValues, ErrorFallsWithEveryTermToZero) {
  const Matrix m = random_matrix(20, 8, 8, -1, 2);
  double last = sum_of_squares(m);
  for (std::size_t terms = 1; terms <= 8; ++terms) {
    const double error = squared_error(m, singular_values(m, terms));
    EXPECT_LT(error, last);
    last = error;
  }
  EXPECT_LT(last, 1e-14 * sum_of_squares(m));
  EXPECT_EQ(singular_values(m, 100).terms, 8u);
}

TEST(SingularValues, OfZeroAreZero) {
  const LowRank f = singular_values({4, 3, std::vector<double>(12)}, 2);
  EXPECT_TRUE(std::all_of(f.u.begin(), f.u.end(), [](double x) { return x == 0; }));
}

TEST(NormalizedDecomposition, IsExactForRankOneAndPositiveForPositive) {
  const Matrix one = random_matrix(9, 14, 1, 0.1, 3);
  EXPECT_LT(squared_error(one, normalized_decomposition(one)), 1e-24 * sum_of_squares(one));
  const Matrix three = random_matrix(9, 14, 3, 0.1, 4);
  const LowRank f = normalized_decomposition(three);
  for (const double x : f.u) EXPECT_GT(x, 0);
  for (const double x : f.v) EXPECT_GT(x, 0);
  // no better than the best of rank one
  EXPECT_GE(squared_error(three, f), squared_error(three, singular_values(three, 1)));
}

}  // namespace
}  // namespace burnish
