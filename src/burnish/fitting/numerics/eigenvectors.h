// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace burnish {

/// The eigenvectors of a symmetric matrix that belong to its `count` largest eigenvalues, largest first, as columns of
/// length 1, their signs left open. Only the lower triangle counts. `count` is at most the number of rows.
Eigen::MatrixXd leading_eigenvectors(const Eigen::MatrixXd& symmetric, Eigen::Index count);

}  // namespace burnish
