#pragma once

#include <optional>

#include <Eigen/SparseCore>

namespace burnish {

/// The lower triangle of a symmetric matrix, row by row.
using SparseTriangle = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// About the Cholesky factor of a symmetric positive definite matrix: it has entries only where the matrix has
/// [Meijerink 1977]. A preconditioner.
class IncompleteCholesky {
 public:
  /// Every row of `matrix` has a diagonal entry. Where what is left out makes a pivot negative, a share of the
  /// diagonal is added to it, larger until all are positive. `last_share` is the one that a matrix much like this
  /// one took: the search starts below it.
  explicit IncompleteCholesky(const SparseTriangle& matrix, double last_share = 0);
  double share() const noexcept { return share_; }

  /// (L L^T)^-1 b.
  Eigen::VectorXd solve(Eigen::VectorXd b) const;

 private:
  bool factorize(const SparseTriangle& matrix);

  SparseTriangle factor_;  ///< the diagonal's reciprocals in its place
  double share_;
};

}  // namespace burnish
