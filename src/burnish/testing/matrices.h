// SPDX-License-Identifier: Apache-2.0
#pragma once

// Matrices for tests of decompositions.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <burnish/fitting/baselines/low_rank.h>
#include <burnish/math/random.h>

namespace burnish::fixtures {

/// Returns a matrix of the given rank with entries u v, u and v uniform in [low, 1).
inline Matrix random_matrix(std::size_t rows, std::size_t columns, std::size_t rank, double low,
                            std::uint64_t seed) {
  Pcg32 random(seed);
  Matrix m{rows, columns, std::vector<double>(rows * columns)};
  for (std::size_t k = 0; k < rank; ++k) {
    std::vector<double> u(rows), v(columns);
    for (double& x : u) x = low + (1 - low) * random.uniform();
    for (double& x : v) x = low + (1 - low) * random.uniform();
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) m.values[r * columns + c] += u[r] * v[c];
  }
  return m;
}

inline double sum_of_squares(const Matrix& m) {
  double sum = 0;
  for (const double x : m.values) sum += x * x;
  return sum;
}

}  // namespace burnish::fixtures
