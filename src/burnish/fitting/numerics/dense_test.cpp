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

}  // namespace
}  // namespace burnish
