#pragma once

#include <Eigen/Core>

namespace burnish {

/// x := matrix^-1 x of a symmetric positive definite matrix of which the lower triangle counts and is
/// replaced by its factor. Zero where rounding made the matrix indefinite. By LAPACK.
void solve_in_place(Eigen::MatrixXd& matrix, Eigen::VectorXd& x);

/// Replaces such a matrix by the upper triangular U with U^T U = matrix^-1; false where rounding made it
/// indefinite. What stands below the diagonal is meaningless.
bool factorize_inverse(Eigen::MatrixXd& matrix);

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// result := op(a) op(b), op being the transpose where asked. By BLAS, for large matrices.
/// Precondition: the sizes fit, that of the result included.
void multiply(const RowMajorMatrix& a, bool transpose_a, const RowMajorMatrix& b, bool transpose_b,
              RowMajorMatrix& result);

}  // namespace burnish
