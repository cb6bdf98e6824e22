// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace burnish {

/// A matrix of real numbers, row by row.
struct Matrix {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;

  double operator()(std::size_t row, std::size_t column) const noexcept {
    return values[row * columns + column];
  }
};

/// m(r, c) is about the sum over k of u[r * terms + k] * v[c * terms + k].
struct LowRank {
  std::size_t terms = 0;
  std::vector<double> u, v;
};

/// The best approximation in the sum of squares, of at most `terms` terms, each singular value shared evenly
/// between u and v. Computed from the product of the matrix with its transpose on the smaller side: singular
/// values below 1e-7 of the largest are lost. [Kautz 1999, eq. 3]
LowRank singular_values(const Matrix& m, std::size_t terms);

/// One term: u is the mean absolute value of each row, v the mean of the rows divided by it. Costs one pass,
/// and is exact for a matrix of rank 1 whose entries are of one sign. [Kautz 1999, sec. 4.2]
LowRank normalized_decomposition(const Matrix& m);

/// u, v >= 0 by at most `iterations` multiplicative updates for the sum of weight * (m - u v)^2, in single
/// precision, from a seeded random start; the sum never rises but by rounding. Ends before where no value of
/// the longer side changes by more than 1e-5 of itself. Precondition: entries and weights >= 0, weights of
/// the size of m. Source: [Lee 2001], weighted as in [Blondel 2008].
LowRank nonnegative_factors(const Matrix& m, std::span<const double> weights, std::size_t terms,
                            int iterations, std::uint64_t seed);

/// The sum of weight * (m - u v)^2; weight 1 where `weights` is empty.
double squared_error(const Matrix& m, const LowRank& factors, std::span<const double> weights = {});

}  // namespace burnish
