// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace burnish {

/// Sets x to matrix^-1 x of a symmetric positive definite matrix, of which only the lower triangle is read. The
/// factor replaces it. x becomes zero where rounding made the matrix indefinite. By LAPACK.
void solve_in_place(Eigen::MatrixXd& matrix, Eigen::VectorXd& x);

/// Replaces such a matrix by the upper triangular U with U^T U = matrix^-1. Returns false where rounding made it
/// indefinite. The entries below the diagonal are meaningless.
bool factorize_inverse(Eigen::MatrixXd& matrix);

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Returns a a^T, or a^T a: its lower triangle, 0 above. By BLAS, for large matrices.
Eigen::MatrixXd products_of_rows(const Eigen::Ref<const RowMajorMatrix>& a);
Eigen::MatrixXd products_of_columns(const Eigen::Ref<const RowMajorMatrix>& a);

}  // namespace burnish
