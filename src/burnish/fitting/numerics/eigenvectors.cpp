// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>

#include <burnish/fitting/numerics/eigenvectors.h>

namespace burnish {

Eigen::MatrixXd leading_eigenvectors(const Eigen::MatrixXd& symmetric, Eigen::Index count) {
  // eigenvalues rise
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric)
      .eigenvectors()
      .rightCols(count)
      .rowwise()
      .reverse();
}

}  // namespace burnish
