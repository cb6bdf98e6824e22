#include <cmath>
#include <vector>

#include <burnish/fitting/numerics/incomplete_cholesky.h>

namespace burnish {

namespace {

constexpr double kFirstShare = 1e-3;  // of the diagonal, where it must be larger
constexpr double kMoreShare = 4;

}  // namespace

IncompleteCholesky::IncompleteCholesky(const SparseTriangle& matrix, double last_share)
    : factor_(matrix), share_(last_share > kFirstShare ? last_share / kMoreShare : 0) {
  while (!factorize(matrix)) share_ = share_ > 0 ? kMoreShare * share_ : kFirstShare;
}

bool IncompleteCholesky::factorize(const SparseTriangle& matrix) {
  const int *starts = factor_.outerIndexPtr(), *columns = factor_.innerIndexPtr();
  double* values = factor_.valuePtr();
  std::vector<double> row(static_cast<std::size_t>(matrix.rows()));  // row i, 0 where it has no entry
  for (int i = 0; i < matrix.rows(); ++i) {
    const int diagonal = starts[i + 1] - 1;
    for (int at = starts[i]; at < diagonal; ++at)
      row[static_cast<std::size_t>(columns[at])] = matrix.valuePtr()[at];
    double pivot = (1 + share_) * matrix.valuePtr()[diagonal];

    // l_ij = (a_ij - sum over k < j of l_ik l_jk) / l_jj
    for (int at = starts[i]; at < diagonal; ++at) {
      const int j = columns[at], last = starts[j + 1] - 1;
      double sum = row[static_cast<std::size_t>(j)];
      for (int of_j = starts[j]; of_j < last; ++of_j)
        sum -= row[static_cast<std::size_t>(columns[of_j])] * values[of_j];
      values[at] = row[static_cast<std::size_t>(j)] = sum * values[last];
      pivot -= values[at] * values[at];
    }
    for (int at = starts[i]; at < diagonal; ++at) row[static_cast<std::size_t>(columns[at])] = 0;
    if (!(pivot > 0)) return false;
    values[diagonal] = 1 / std::sqrt(pivot);
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
