// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <burnish/fitting/numerics/band_matrix.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

TEST(BandMatrix, SolvesAsADenseMatrixDoes) {
  Pcg32 random(6);
  for (const std::size_t size : {1, 2, 7, 40})
    for (const std::size_t width : {std::size_t{0}, std::size_t{1}, std::size_t{5}}) {
      BandMatrix band(size, width);
      const auto n = static_cast<Eigen::Index>(size);
      Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
      for (std::size_t row = 0; row < size; ++row)
        for (std::size_t column = row > width ? row - width : 0; column <= row; ++column) {
          // diagonally dominant, hence positive definite
          const double value = row == column ? 2.0 * static_cast<double>(width) + 1 : random.uniform() - 0.5;
          band(row, column) = value;
          const auto r = static_cast<Eigen::Index>(row), c = static_cast<Eigen::Index>(column);
          dense(r, c) = dense(c, r) = value;
        }
      Eigen::VectorXd right(n);
      for (double& b : right) b = random.uniform();
      ASSERT_TRUE(band.factorize());
      const Eigen::VectorXd found = band.solve(right);
      EXPECT_LT((dense * found - right).norm(), 1e-12 * static_cast<double>(size)) << size << " " << width;
    }
}

TEST(BandMatrix, TellsWhatIsIndefinite) {
  BandMatrix band(2, 1);
  band(0, 0) = band(1, 1) = 1;
  band(1, 0) = 2;
  EXPECT_FALSE(band.factorize());
}

}  // namespace
}  // namespace burnish
