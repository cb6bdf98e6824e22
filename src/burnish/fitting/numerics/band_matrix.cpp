// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <burnish/fitting/numerics/band_matrix.h>
#include <burnish/fitting/numerics/lapack_lock.h>

extern "C" {
void dpbtrf_(const char* triangle, const int* n, const int* width, double* matrix, const int* stride,
             int* info);
void dpbtrs_(const char* triangle, const int* n, const int* width, const int* columns, const double* matrix,
             const int* stride, double* right_sides, const int* right_stride, int* info);
}

namespace burnish {

void BandMatrix::set_zero() {
  std::ranges::fill(lower_, 0.0);
}

bool BandMatrix::factorize() {
  const int n = static_cast<int>(size_), width = static_cast<int>(width_), stride = width + 1;
  int info = 0;
  const std::lock_guard one_at_a_time(lapack_mutex());
  dpbtrf_("L", &n, &width, lower_.data(), &stride, &info);
  return info == 0;
}

double BandMatrix::follow(std::size_t i, const Eigen::VectorXd& changes) const noexcept {
  // v^T L L^T v is a sum of squares, one for each unknown. The unknowns before i can make theirs 0, so the square of
  // i, which holds i and those after it, decides: it is 0 at the value returned.
  const double* column = lower_.data() + i * (width_ + 1);
  const std::size_t count = std::min(width_, size_ - 1 - i);
  double sum = 0;
  for (std::size_t k = 1; k <= count; ++k) sum += column[k] * changes[static_cast<Eigen::Index>(i + k)];
  return -sum / column[0];
}

Eigen::VectorXd BandMatrix::solve(Eigen::VectorXd b) const {
  const int n = static_cast<int>(size_), width = static_cast<int>(width_), stride = width + 1, one = 1;
  int info = 0;
  const std::lock_guard one_at_a_time(lapack_mutex());
  dpbtrs_("L", &n, &width, &one, lower_.data(), &stride, b.data(), &n, &info);
  return b;
}

}  // namespace burnish
