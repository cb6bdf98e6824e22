#pragma once

#include <vector>

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
  /// one took: the search starts below it. The last `dense_rows` rows have an entry for each two of them: they make a
  /// dense matrix, less coupled to what stands before them where that keeps it positive.
  explicit IncompleteCholesky(const SparseTriangle& matrix, double last_share = 0, int dense_rows = 0);
  double share() const noexcept { return share_; }

  /// (L L^T)^-1 b.
  Eigen::VectorXd solve(Eigen::VectorXd b) const;

 private:
  bool factorize(const SparseTriangle& matrix, int dense_rows);
  // Row i's entries in the first `columns` columns and what they leave of the pivot; `row` is room, all zero.
  double eliminate(const SparseTriangle& matrix, int i, int columns, std::vector<double>& row);

  SparseTriangle factor_;  ///< the diagonal's reciprocals in its place
  double share_;
};

}  // namespace burnish
