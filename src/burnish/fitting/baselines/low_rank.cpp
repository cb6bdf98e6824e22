// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include <burnish/fitting/baselines/low_rank.h>
#include <burnish/fitting/numerics/dense.h>
#include <burnish/fitting/numerics/eigenvectors.h>

namespace burnish {

namespace {

using RowMajor = RowMajorMatrix;
using ConstMap = Eigen::Map<const RowMajor>;
using Eigen::Index;

ConstMap map(const Matrix& m) {
  return {m.values.data(), static_cast<Index>(m.rows), static_cast<Index>(m.columns)};
}

std::vector<double> to_vector(const RowMajor& m) {
  return {m.data(), m.data() + m.size()};
}

LowRank make_low_rank(const RowMajor& u, const RowMajor& v) {
  return {static_cast<std::size_t>(u.cols()), to_vector(u), to_vector(v)};
}

}  // namespace

LowRank singular_values(const Matrix& m, std::size_t terms) {
  const ConstMap a = map(m);
  const bool wide = m.columns > m.rows;
  const Eigen::MatrixXd gram = wide ? products_of_rows(a) : products_of_columns(a);
  const Index kept = std::min(static_cast<Index>(terms), gram.rows());
  // eigenvalues are the squares of singular values
  RowMajor near = leading_eigenvectors(gram, kept);
  RowMajor far = wide ? RowMajor(a.transpose() * near) : RowMajor(a * near);
  for (Index k = 0; k < kept; ++k) {
    const double sigma = far.col(k).norm();
    if (sigma <= 0) continue;
    far.col(k) /= std::sqrt(sigma);
    near.col(k) *= std::sqrt(sigma);
  }
  return wide ? make_low_rank(near, far) : make_low_rank(far, near);
}

LowRank normalized_decomposition(const Matrix& m) {
  LowRank result{1, std::vector<double>(m.rows), std::vector<double>(m.columns)};
  std::size_t counted = 0;
  for (std::size_t r = 0; r < m.rows; ++r) {
    double norm = 0;
    for (std::size_t c = 0; c < m.columns; ++c) norm += std::abs(m(r, c));
    norm /= static_cast<double>(m.columns);
    result.u[r] = norm;
    if (norm <= 0) continue;
    ++counted;
    for (std::size_t c = 0; c < m.columns; ++c) result.v[c] += m(r, c) / norm;
  }
  for (double& v : result.v) v /= static_cast<double>(std::max<std::size_t>(counted, 1));
  return result;
}

double squared_error(const Matrix& m, const LowRank& factors, std::span<const double> weights) {
  double sum = 0;
  for (std::size_t r = 0; r < m.rows; ++r)
    for (std::size_t c = 0; c < m.columns; ++c) {
      double fitted = 0;
      for (std::size_t k = 0; k < factors.terms; ++k)
        fitted += factors.u[r * factors.terms + k] * factors.v[c * factors.terms + k];
      const double error = m(r, c) - fitted;
      sum += (weights.empty() ? 1 : weights[r * m.columns + c]) * error * error;
    }
  return sum;
}

}  // namespace burnish
