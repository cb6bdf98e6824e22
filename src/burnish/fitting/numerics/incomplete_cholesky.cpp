// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include <burnish/fitting/numerics/dense.h>
#include <burnish/fitting/numerics/incomplete_cholesky.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

using Lanes = Eigen::Array<double, IncompleteCholesky::kLanes, 1>;

constexpr double kFirstShare = 1e-3;  // first share of the diagonal that is added, where 0 does not serve
constexpr double kMoreShare = 4;
// Factors of the coupling between the dense rows and the rows before them, tried in turn; the last one is 0.
constexpr double kLessCoupling = 0.8, kMinCoupling = 0.3;

// Parts of a solution that a thread takes at a time, of some hundred thousand products.
constexpr int kBlocksAtOnce = 4;
constexpr std::size_t kColumnsAtOnce = 512;

// Returns the inner product of `count` numbers.
double dot(const double* a, const double* b, int count) {
  return Eigen::VectorXd::Map(a, count).dot(Eigen::VectorXd::Map(b, count));
}

/// Subtracts: to -= scale * from.
void subtract(double* to, double scale, const double* from, int count) {
  Eigen::VectorXd::Map(to, count) -= scale * Eigen::VectorXd::Map(from, count);
}

}  // namespace

TriangleRuns::TriangleRuns(const SparseTriangle& matrix) {
  const int *starts = matrix.outerIndexPtr(), *columns = matrix.innerIndexPtr();
  starts_.assign(1, 0);
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int at = starts[i]; at < starts[i + 1]; ++at)
      if (at > starts[i] && columns[at] == columns[at - 1] + 1)
        ++runs_.back().length;
      else
        runs_.push_back({columns[at], at, 1});
    starts_.push_back(runs_.size());
  }
}

Eigen::VectorXd symmetric_times(const SparseTriangle& matrix, const TriangleRuns& runs,
                                const Eigen::VectorXd& v) {
  const double* values = matrix.valuePtr();
  Eigen::VectorXd product = Eigen::VectorXd::Zero(v.size());
  for (int i = 0; i < matrix.rows(); ++i) {
    // Each stored row i serves twice: (A v)_i takes its entries times v, and its entries times v_i go to the other
    // rows.
    double sum = 0;
    for (const TriangleRuns::Run& run : runs.row(i)) {
      sum += dot(values + run.at, v.data() + run.column, run.length);
      subtract(product.data() + run.column, -v[i], values + run.at, run.length);
    }
    // Both added the diagonal, which counts once.
    product[i] += sum - values[matrix.outerIndexPtr()[i + 1] - 1] * v[i];
  }
  return product;
}

IncompleteCholesky::IncompleteCholesky(const SparseTriangle& matrix, double last_share, int dense_rows)
    : factor_(matrix),
      runs_(matrix),
      dense_rows_(dense_rows),
      share_(last_share > kFirstShare ? last_share / kMoreShare : 0) {
  const auto blocks = static_cast<std::size_t>((dense_rows + kLanes - 1) / kLanes);
  before_.resize(blocks * kLanes * static_cast<std::size_t>(first_dense()));
  // Leaving out fill-in may make a pivot negative. Then a growing share of the diagonal is added until all are
  // positive.
  while (!factorize(matrix)) share_ = share_ > 0 ? kMoreShare * share_ : kFirstShare;
}

double* IncompleteCholesky::block_of(int i) noexcept {
  const int block = (i - first_dense()) / kLanes;
  return before_.data() + static_cast<std::size_t>(block) * kLanes * static_cast<std::size_t>(first_dense());
}

double IncompleteCholesky::eliminate(const SparseTriangle& matrix, int i, std::vector<double>& row) {
  const int *starts = factor_.outerIndexPtr(), *column = factor_.innerIndexPtr();
  double* values = factor_.valuePtr();
  const int diagonal = starts[i + 1] - 1;
  // Row i is spread out over its columns; its pivot is the diagonal with the share added.
  for (int at = starts[i]; at < diagonal; ++at)
    row[static_cast<std::size_t>(column[at])] = matrix.valuePtr()[at];
  double pivot = (1 + share_) * matrix.valuePtr()[diagonal];

  // l_ij = (a_ij - sum over k < j of l_ik l_jk) / l_jj, for the entries (i, j) of the matrix alone [Meijerink 1977].
  for (int at = starts[i]; at < diagonal; ++at) {
    const int j = column[at], last = starts[j + 1] - 1;
    double sum = row[static_cast<std::size_t>(j)];
    for (const TriangleRuns::Run& run : runs_.row(j)) {
      const int length = std::min(run.length, last - run.at);  // without the diagonal
      sum -= dot(row.data() + run.column, values + run.at, length);
    }
    values[at] = row[static_cast<std::size_t>(j)] = sum * values[last];
    pivot -= values[at] * values[at];
  }
  for (int at = starts[i]; at < diagonal; ++at) row[static_cast<std::size_t>(column[at])] = 0;
  return pivot;
}

// Eliminates kLanes rows at once. Each has the sums that it would have alone, in their order.
void IncompleteCholesky::eliminate_block(const SparseTriangle& matrix, int first, double* block) const {
  const int *starts = factor_.outerIndexPtr(), *column = factor_.innerIndexPtr();
  const double* values = factor_.valuePtr();
  const int columns = first_dense(), lanes = std::min(kLanes, static_cast<int>(factor_.rows()) - first);

  // The matrix's entries go to lanes, and a mask says which entries there are.
  std::fill_n(block, static_cast<std::ptrdiff_t>(columns) * kLanes, 0.0);
  std::vector<Lanes> there(static_cast<std::size_t>(columns), Lanes::Zero());  // 1 or 0
  for (int lane = 0; lane < lanes; ++lane)
    for (int at = starts[first + lane]; at < dense_start(first + lane); ++at) {
      block[column[at] * kLanes + lane] = matrix.valuePtr()[at];
      there[static_cast<std::size_t>(column[at])][lane] = 1;
    }

  for (int j = 0; j < columns; ++j) {
    // The formula is that of eliminate(), with lanes that have no entry set to 0.
    const int last = starts[j + 1] - 1;
    Lanes sum = Lanes::Map(block + j * kLanes);
    for (const TriangleRuns::Run& run : runs_.row(j)) {
      const double* const before = block + run.column * kLanes;
      for (int k = 0; k < std::min(run.length, last - run.at); ++k)
        sum -= Lanes::Map(before + k * kLanes) * values[run.at + k];
    }
    Lanes::Map(block + j * kLanes) = there[static_cast<std::size_t>(j)] * sum * values[last];
  }
}

bool IncompleteCholesky::factorize(const SparseTriangle& matrix) {
  const int *starts = factor_.outerIndexPtr(), *column = factor_.innerIndexPtr();
  double* values = factor_.valuePtr();
  const int size = static_cast<int>(matrix.rows()), first = first_dense();
  std::vector<double> row(static_cast<std::size_t>(first));
  // The sparse rows are eliminated one after the other; a pivot that is not positive ends the attempt.
  for (int i = 0; i < first; ++i) {
    const double pivot = eliminate(matrix, i, row);
    if (!(pivot > 0)) return false;
    values[starts[i + 1] - 1] = 1 / std::sqrt(pivot);
  }
  if (dense_rows_ == 0) return true;

  // The dense rows are eliminated against the sparse ones first, in blocks. With B these entries and D the dense
  // rows' own matrix, the complement is D - B B^T.
  for_each_chunk(static_cast<std::size_t>(dense_rows_), kLanes,
                 [&](std::size_t, std::size_t begin, std::size_t) {
                   const int i = first + static_cast<int>(begin);
                   eliminate_block(matrix, i, block_of(i));
                 });
  RowMajorMatrix before(dense_rows_, first);
  Eigen::MatrixXd complement(dense_rows_, dense_rows_);
  for (int i = first; i < size; ++i) {
    const double* const block = block_of(i) + (i - first) % kLanes;
    for (int j = 0; j < first; ++j) before(i - first, j) = block[j * kLanes];
    for (int at = dense_start(i); at < starts[i + 1]; ++at)
      complement(i - first, column[at] - first) = (column[at] == i ? 1 + share_ : 1) * matrix.valuePtr()[at];
  }
  // If that is not positive, B is coupled less: c B B^T with c < 1 leaves a larger complement.
  const Eigen::MatrixXd products = products_of_rows(before), diagonal = complement;
  double coupling = 1;
  for (;; coupling = coupling > kMinCoupling ? kLessCoupling * coupling : 0) {
    complement.triangularView<Eigen::Lower>() = diagonal - coupling * products;
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(complement);
    if (in_place.info() == Eigen::Success) break;
    if (coupling == 0) return false;
  }
  for (double& value : before_) value *= std::sqrt(coupling);
  for (int i = first; i < size; ++i)
    for (int at = dense_start(i); at < starts[i + 1]; ++at) {
      const double value = complement(i - first, column[at] - first);
      values[at] = column[at] == i ? 1 / value : value;
    }
  return true;
}

Eigen::VectorXd IncompleteCholesky::solve_lower(Eigen::VectorXd b) const {
  const int* starts = factor_.outerIndexPtr();
  const double* values = factor_.valuePtr();
  const int size = static_cast<int>(factor_.rows()), first = first_dense();
  const std::ptrdiff_t block_size = std::ptrdiff_t{first} * kLanes;

  // L x = b is solved from the first row to the last; the diagonal holds reciprocals.
  for (int i = 0; i < first; ++i) {
    const int diagonal = starts[i + 1] - 1;
    double sum = b[i];
    for (const TriangleRuns::Run& run : runs_.row(i))
      sum -= dot(values + run.at, b.data() + run.column, std::min(run.length, diagonal - run.at));
    b[i] = sum * values[diagonal];
  }
  // Blocks are split between threads. Each number's sum is in the order of one thread.
  for_each_chunk(static_cast<std::size_t>(dense_rows_), kBlocksAtOnce * kLanes,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   for (auto row = static_cast<int>(begin); row < static_cast<int>(end); row += kLanes) {
                     const double* const block = before_.data() + row / kLanes * block_size;
                     const int i = first + row, lanes = std::min(kLanes, size - i);
                     Lanes sum = Lanes::Zero();
                     sum.head(lanes) = b.segment(i, lanes).array();
                     for (int k = 0; k < first; ++k) sum -= Lanes::Map(block + k * kLanes) * b[k];
                     b.segment(i, lanes) = sum.head(lanes);
                   }
                 });
  // The dense rows follow, by their own triangle.
  for (int i = first; i < size; ++i) {
    const double* const row = values + dense_start(i);
    b[i] = (b[i] - dot(row, b.data() + first, i - first)) * row[i - first];
  }
  return b;
}

Eigen::VectorXd IncompleteCholesky::solve_upper(Eigen::VectorXd b) const {
  const int* starts = factor_.outerIndexPtr();
  const double* values = factor_.valuePtr();
  const int size = static_cast<int>(factor_.rows()), first = first_dense();
  const std::ptrdiff_t block_size = std::ptrdiff_t{first} * kLanes;

  // L^T x = b is solved from the last row to the first.
  for (int i = size - 1; i >= first; --i) {
    const double* const row = values + dense_start(i);
    b[i] *= row[i - first];
    subtract(b.data() + first, b[i], row, i - first);
  }
  // Columns are split between threads, each with the sums of one thread in their order.
  if (dense_rows_ > 0)
    for_each_chunk(static_cast<std::size_t>(first), kColumnsAtOnce,
                   [&](std::size_t, std::size_t begin, std::size_t end) {
                     for (int row = (dense_rows_ - 1) / kLanes * kLanes; row >= 0; row -= kLanes) {
                       const double* const block = before_.data() + row / kLanes * block_size;
                       const int i = first + row, lanes = std::min(kLanes, size - i);
                       for (auto k = static_cast<int>(begin); k < static_cast<int>(end); ++k) {
                         double sum = b[k];
                         for (int lane = lanes - 1; lane >= 0; --lane)
                           sum -= block[k * kLanes + lane] * b[i + lane];
                         b[k] = sum;
                       }
                     }
                   });
  for (int i = first - 1; i >= 0; --i) {
    const int diagonal = starts[i + 1] - 1;
    b[i] *= values[diagonal];
    for (const TriangleRuns::Run& run : runs_.row(i))
      subtract(b.data() + run.column, b[i], values + run.at, std::min(run.length, diagonal - run.at));
  }
  return b;
}

}  // namespace burnish
