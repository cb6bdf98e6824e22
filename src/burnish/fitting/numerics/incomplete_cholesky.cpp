#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include <burnish/fitting/numerics/dense.h>
#include <burnish/fitting/numerics/incomplete_cholesky.h>

namespace burnish {

namespace {

constexpr double kFirstShare = 1e-3;  // of the diagonal, where it must be larger
constexpr double kMoreShare = 4;
// Of the dense rows with what stands before them, tried in turn; then none.
constexpr double kLessCoupling = 0.8, kMinCoupling = 0.3;

}  // namespace

IncompleteCholesky::IncompleteCholesky(const SparseTriangle& matrix, double last_share, int dense_rows)
    : factor_(matrix), share_(last_share > kFirstShare ? last_share / kMoreShare : 0) {
  while (!factorize(matrix, dense_rows)) share_ = share_ > 0 ? kMoreShare * share_ : kFirstShare;
}

double IncompleteCholesky::eliminate(const SparseTriangle& matrix, int i, int columns,
                                     std::vector<double>& row) {
  const int *starts = factor_.outerIndexPtr(), *column = factor_.innerIndexPtr();
  double* values = factor_.valuePtr();
  const int diagonal = starts[i + 1] - 1;
  const int end = static_cast<int>(std::lower_bound(column + starts[i], column + diagonal, columns) - column);
  for (int at = starts[i]; at < end; ++at) row[static_cast<std::size_t>(column[at])] = matrix.valuePtr()[at];
  double pivot = (1 + share_) * matrix.valuePtr()[diagonal];

  // l_ij = (a_ij - sum over k < j of l_ik l_jk) / l_jj
  for (int at = starts[i]; at < end; ++at) {
    const int j = column[at], last = starts[j + 1] - 1;
    double sum = row[static_cast<std::size_t>(j)];
    for (int of_j = starts[j]; of_j < last; ++of_j)
      sum -= row[static_cast<std::size_t>(column[of_j])] * values[of_j];
    values[at] = row[static_cast<std::size_t>(j)] = sum * values[last];
    pivot -= values[at] * values[at];
  }
  for (int at = starts[i]; at < end; ++at) row[static_cast<std::size_t>(column[at])] = 0;
  return pivot;
}

bool IncompleteCholesky::factorize(const SparseTriangle& matrix, int dense_rows) {
  const int *starts = factor_.outerIndexPtr(), *column = factor_.innerIndexPtr();
  double* values = factor_.valuePtr();
  const int size = static_cast<int>(matrix.rows()), first_dense = size - dense_rows;
  std::vector<double> row(static_cast<std::size_t>(size));
  for (int i = 0; i < first_dense; ++i) {
    const double pivot = eliminate(matrix, i, i, row);
    if (!(pivot > 0)) return false;
    values[starts[i + 1] - 1] = 1 / std::sqrt(pivot);
  }
  if (dense_rows == 0) return true;

  // of the dense rows first what stands before them, then the complement that this leaves
  RowMajorMatrix before = RowMajorMatrix::Zero(dense_rows, first_dense);
  Eigen::MatrixXd complement(dense_rows, dense_rows);
  for (int i = first_dense; i < size; ++i) {
    eliminate(matrix, i, first_dense, row);
    for (int at = starts[i]; at < starts[i + 1]; ++at)
      if (column[at] < first_dense)
        before(i - first_dense, column[at]) = values[at];
      else
        complement(i - first_dense, column[at] - first_dense) =
            (column[at] == i ? 1 + share_ : 1) * matrix.valuePtr()[at];
  }
  // and with less of it where that is not positive: a smaller coupling of the two leaves a larger complement
  const Eigen::MatrixXd products = products_of_rows(before), diagonal = complement;
  double coupling = 1;
  for (;; coupling = coupling > kMinCoupling ? kLessCoupling * coupling : 0) {
    complement.triangularView<Eigen::Lower>() = diagonal - coupling * products;
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(complement);
    if (in_place.info() == Eigen::Success) break;
    if (coupling == 0) return false;
  }
  for (int i = first_dense; i < size; ++i)
    for (int at = starts[i]; at < starts[i + 1] - (i - first_dense) - 1; ++at)
      values[at] *= std::sqrt(coupling);
  for (int i = first_dense; i < size; ++i)
    for (int at = starts[i + 1] - (i - first_dense) - 1; at < starts[i + 1]; ++at) {
      const double value = complement(i - first_dense, column[at] - first_dense);
      values[at] = column[at] == i ? 1 / value : value;
    }
  return true;
}

Eigen::VectorXd IncompleteCholesky::solve(Eigen::VectorXd b) const {
  const int *starts = factor_.outerIndexPtr(), *columns = factor_.innerIndexPtr();
  const double* values = factor_.valuePtr();
  for (int i = 0; i < factor_.rows(); ++i) {
    const int diagonal = starts[i + 1] - 1;
    double sum = b[i];
    for (int at = starts[i]; at < diagonal; ++at) sum -= values[at] * b[columns[at]];
    b[i] = sum * values[diagonal];
  }
  for (int i = static_cast<int>(factor_.rows()) - 1; i >= 0; --i) {
    const int diagonal = starts[i + 1] - 1;
    const double x = b[i] *= values[diagonal];
    for (int at = starts[i]; at < diagonal; ++at) b[columns[at]] -= values[at] * x;
  }
  return b;
}

}  // namespace burnish
