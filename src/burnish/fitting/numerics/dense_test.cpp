// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/fitting/numerics/dense.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

TEST(Products, AreThoseOfAllPairsOfRowsOrColumns) {
  Pcg32 random(1);
  const RowMajorMatrix a = RowMajorMatrix::NullaryExpr(7, 4, [&] { return random.uniform() - 0.5; });
  const Eigen::MatrixXd rows = products_of_rows(a), columns = products_of_columns(a);
  ASSERT_EQ(rows.rows(), 7);
  ASSERT_EQ(columns.cols(), 4);
  for (Eigen::Index i = 0; i < 7; ++i)
    for (Eigen::Index j = 0; j < 7; ++j) EXPECT_NEAR(rows(i, j), j <= i ? a.row(i).dot(a.row(j)) : 0, 1e-14);
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index j = 0; j < 4; ++j)
      EXPECT_NEAR(columns(i, j), j <= i ? a.col(i).dot(a.col(j)) : 0, 1e-14);
}

TEST(Cholesky, SolvesAndFactorizesTheInverse) {
  Pcg32 random(5);
  Eigen::MatrixXd root(12, 12);
  for (double& v : root.reshaped()) v = random.uniform() - 0.5;
  const Eigen::MatrixXd matrix = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(12, 12);
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(12, -1, 1), b = x;
  Eigen::MatrixXd used = matrix;
  solve_in_place(used, x);
  EXPECT_LT((matrix * x - b).cwiseAbs().maxCoeff(), 1e-12);
  used = matrix;
  ASSERT_TRUE(factorize_inverse(used));
  const Eigen::MatrixXd upper = used.triangularView<Eigen::Upper>();
  EXPECT_LT((upper.transpose() * upper * matrix - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(),
            1e-10);
  used = -matrix;
  EXPECT_FALSE(factorize_inverse(used));
  used = -matrix;
  solve_in_place(used, x);
  EXPECT_EQ(x.cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace burnish
