// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/fitting/numerics/eigenvectors.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

TEST(Eigenvectors, AreThoseOfTheLargestValuesInOrder) {
  // q diag(d) q^T with a q that is orthogonal by its making
  Pcg32 random(2);
  Eigen::MatrixXd q(9, 9);
  for (double& v : q.reshaped()) v = random.uniform() - 0.5;
  for (Eigen::Index k = 0; k < 9; ++k) {
    for (int again = 0; again < 2; ++again)
      for (Eigen::Index j = 0; j < k; ++j) q.col(k) -= q.col(j).dot(q.col(k)) * q.col(j);
    q.col(k).normalize();
  }
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(9, 9, -1);
  Eigen::MatrixXd matrix = q * values.asDiagonal() * q.transpose();
  matrix.triangularView<Eigen::StrictlyUpper>().setConstant(1e9);
  const Eigen::MatrixXd found = leading_eigenvectors(matrix, 4);
  ASSERT_EQ(found.rows(), 9);
  ASSERT_EQ(found.cols(), 4);
  for (Eigen::Index k = 0; k < 4; ++k) EXPECT_NEAR(std::abs(found.col(k).dot(q.col(k))), 1, 1e-12) << k;
}

}  // namespace
}  // namespace burnish
