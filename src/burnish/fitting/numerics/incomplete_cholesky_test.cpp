// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <burnish/fitting/numerics/incomplete_cholesky.h>

namespace burnish {
namespace {

// The lower triangle of a sum of products of rows of `terms` neighbours, and a share of one on the diagonal.
SparseTriangle banded(int size, int terms, double share) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, share);
  for (int row = 0; row + terms <= size; ++row) {
    const Eigen::VectorXd v = Eigen::VectorXd::NullaryExpr(terms, [&] { return uniform(random); });
    for (int a = 0; a < terms; ++a)
      for (int b = 0; b <= a; ++b) entries.emplace_back(row + a, row + b, v[a] * v[b]);
  }
  SparseTriangle matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(IncompleteCholesky, IsExactWhereNothingIsLeftOut) {
  const SparseTriangle matrix = banded(60, 4, 0.1);
  const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(60, -1, 1);
  const Eigen::VectorXd b = matrix.selfadjointView<Eigen::Lower>() * v;
  EXPECT_LT((IncompleteCholesky(matrix).solve(b) - v).norm(), 1e-10 * v.norm());
}

TEST(TriangleRuns, MultiplyTheWholeMatrix) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j <= i; ++j)
      if (i == j || (i * 7 + j * 5) % 11 < 6) entries.emplace_back(i, j, std::sin(i + 3 * j));
  SparseTriangle matrix(50, 50);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(50, -1, 2),
                        expected = matrix.selfadjointView<Eigen::Lower>() * v;
  const TriangleRuns runs(matrix);
  int count = 0;
  for (int i = 0; i < 50; ++i)
    for (const TriangleRuns::Run& run : runs.row(i)) count += run.length;
  EXPECT_EQ(count, matrix.nonZeros());
  EXPECT_LT((symmetric_times(matrix, runs, v) - expected).norm(), 1e-13 * expected.norm());
}

TEST(IncompleteCholesky, IsTheSameWithDenseRows) {
  SparseTriangle matrix = banded(40, 4, 0.1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j <= i; ++j)
      if (i >= 30 || matrix.coeff(i, j) != 0)
        entries.emplace_back(i, j, matrix.coeff(i, j) + (i >= 30 ? 1e-3 * j : 0));
  for (int i = 30; i < 40; ++i) entries.emplace_back(i, i, 5);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(40, -1, 1),
                        sparse = IncompleteCholesky(matrix).solve(b);
  for (const int rows : {1, 4, 10})
    EXPECT_LT((IncompleteCholesky(matrix, 0, rows).solve(b) - sparse).norm(), 1e-12 * sparse.norm()) << rows;
}

TEST(IncompleteCholesky, StaysPositiveWherePivotsAreLost) {
  // a ring of strong negative neighbours: what is left out of the factor exceeds the last pivots
  constexpr int kSize = 40;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < kSize; ++i) entries.emplace_back(i, i, 1.01);
  for (int step : {1, 3, 9})
    for (int i = 0; i + step < kSize; ++i) entries.emplace_back(i + step, i, step == 3 ? 0.4 : -0.45);
  SparseTriangle matrix(kSize, kSize);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixXd dense = matrix.toDense().selfadjointView<Eigen::Lower>();
  const IncompleteCholesky factor(matrix);
  Eigen::MatrixXd inverse(kSize, kSize);
  for (int k = 0; k < kSize; ++k) inverse.col(k) = factor.solve(Eigen::VectorXd::Unit(kSize, k));
  EXPECT_LT((inverse - inverse.transpose()).norm(), 1e-12 * inverse.norm());
  EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(inverse).info(), Eigen::Success);
  EXPECT_NE(Eigen::LLT<Eigen::MatrixXd>(dense).info(), Eigen::Success);  // nor is the matrix itself
}

}  // namespace
}  // namespace burnish
