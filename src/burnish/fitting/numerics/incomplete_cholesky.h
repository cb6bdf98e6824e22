// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/SparseCore>

namespace burnish {

/// The lower triangle of a symmetric matrix, row by row.
using SparseTriangle = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The runs of entries that stand side by side in such a matrix: operations take a whole run at once.
class TriangleRuns {
 public:
  struct Run {
    int column, at, length;  ///< the first entry's column and place among all
  };

  TriangleRuns() = default;
  explicit TriangleRuns(const SparseTriangle& matrix);
  std::span<const Run> row(int i) const noexcept {
    const auto k = static_cast<std::size_t>(i);
    return {runs_.data() + starts_[k], runs_.data() + starts_[k + 1]};
  }

 private:
  std::vector<Run> runs_;
  std::vector<std::size_t> starts_;
};

/// Returns the symmetric matrix times v. Precondition: every row has a diagonal entry.
Eigen::VectorXd symmetric_times(const SparseTriangle& matrix, const TriangleRuns& runs,
                                const Eigen::VectorXd& v);

/// An incomplete Cholesky factor of a symmetric positive definite matrix: it has entries only where the matrix has
/// [Meijerink 1977]. It serves as a preconditioner.
class IncompleteCholesky {
 public:
  static constexpr int kLanes = 8;  ///< dense rows that are worked on at once

  /// Factorizes `matrix`, each of whose rows has a diagonal entry. Where the entries left out make a pivot negative,
  /// a share of the diagonal is added to it, larger until all are positive.
  /// `last_share` is the share that a similar matrix needed; the search starts below it. The last `dense_rows` rows
  /// have an entry for each two of them and make a dense matrix. Their coupling to the rows before is reduced where
  /// that keeps the matrix positive.
  explicit IncompleteCholesky(const SparseTriangle& matrix, double last_share = 0, int dense_rows = 0);
  double share() const noexcept { return share_; }

  /// Returns (L L^T)^-1 b.
  Eigen::VectorXd solve(Eigen::VectorXd b) const { return solve_upper(solve_lower(std::move(b))); }

 private:
  Eigen::VectorXd solve_lower(Eigen::VectorXd b) const;  // L^-1 b
  Eigen::VectorXd solve_upper(Eigen::VectorXd b) const;  // L^-T b
  bool factorize(const SparseTriangle& matrix);
  // Computes row i's entries and returns the pivot that they leave; `row` is room, all zero.
  double eliminate(const SparseTriangle& matrix, int i, std::vector<double>& row);
  // Computes the entries of the dense rows from `first` on in the columns before them, into their block.
  void eliminate_block(const SparseTriangle& matrix, int first, double* block) const;
  int first_dense() const noexcept { return static_cast<int>(factor_.rows()) - dense_rows_; }
  // Returns the index of row i's first entry among the dense ones.
  int dense_start(int i) const noexcept { return factor_.outerIndexPtr()[i + 1] - (i - first_dense()) - 1; }
  double* block_of(int i) noexcept;

  SparseTriangle factor_;  ///< the diagonal's reciprocals in its place
  TriangleRuns runs_;
  int dense_rows_;
  /// Entries of the dense rows in the columns before them, kLanes rows at a time, column by column; not in factor_.
  std::vector<double> before_;
  double share_;
};

}  // namespace burnish
