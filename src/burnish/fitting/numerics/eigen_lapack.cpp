// SPDX-License-Identifier: Apache-2.0
// In place of LAPACK and BLAS where BURNISH_EIGEN_LAPACK is on, and in WebAssembly: the routines that fitting/numerics
// calls, with Eigen. Always the lower triangle, as they are called. Compiled for any processor, without its widest
// vectors, so fits take longer than with OpenBLAS.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace {

using Matrix = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ConstMatrix = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

// Column j of a lower band of that stride: its diagonal element, then those below.
double* column(double* band, int stride, int j) {
  return band + static_cast<std::ptrdiff_t>(j) * stride;
}
const double* column(const double* band, int stride, int j) {
  return band + static_cast<std::ptrdiff_t>(j) * stride;
}

}  // namespace

extern "C" {

void ilaver_(int* major, int* minor, int* patch) {
  *major = *minor = *patch = 0;
}

void dpotrf_(const char*, const int* n, double* matrix, const int* stride, int* info) {
  Matrix a(matrix, *n, *n, Eigen::OuterStride<>(*stride));
  // in place: the upper triangle stays as it is
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>, Eigen::Lower> llt(a);
  *info = llt.info() == Eigen::Success ? 0 : 1;
}

void dtrtri_(const char*, const char*, const int* n, double* matrix, const int* stride, int* info) {
  Matrix a(matrix, *n, *n, Eigen::OuterStride<>(*stride));
  const Eigen::MatrixXd inverse = a.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(*n, *n));
  a.triangularView<Eigen::Lower>() = inverse;
  *info = 0;
}

void dpotrs_(const char*, const int* n, const int* columns, const double* matrix, const int* stride,
             double* right_sides, const int* right_stride, int* info) {
  const ConstMatrix a(matrix, *n, *n, Eigen::OuterStride<>(*stride));
  Matrix x(right_sides, *n, *columns, Eigen::OuterStride<>(*right_stride));
  a.triangularView<Eigen::Lower>().solveInPlace(x);
  a.triangularView<Eigen::Lower>().transpose().solveInPlace(x);
  *info = 0;
}

void dsyrk_(const char*, const char* transpose, const int* n, const int* inner, const double* scale,
            const double* matrix, const int* stride, const double* keep, double* result,
            const int* result_stride) {
  const bool transposed = *transpose == 'T';
  const ConstMatrix a(matrix, transposed ? *inner : *n, transposed ? *n : *inner,
                      Eigen::OuterStride<>(*stride));
  Matrix c(result, *n, *n, Eigen::OuterStride<>(*result_stride));
  c.triangularView<Eigen::Lower>() *= *keep;
  if (transposed)
    c.selfadjointView<Eigen::Lower>().rankUpdate(a.transpose(), *scale);
  else
    c.selfadjointView<Eigen::Lower>().rankUpdate(a, *scale);
}

void dpbtrf_(const char*, const int* n, const int* width, double* band, const int* stride, int* info) {
  *info = 0;
  for (int j = 0; j < *n; ++j) {
    double* const pivot = column(band, *stride, j);
    if (!(pivot[0] > 0)) {
      *info = j + 1;
      return;
    }
    pivot[0] = std::sqrt(pivot[0]);
    const int below = std::min(*width, *n - 1 - j);
    for (int i = 1; i <= below; ++i) pivot[i] /= pivot[0];

    // what the column takes from those right of it
    for (int k = 1; k <= below; ++k) {
      double* const right = column(band, *stride, j + k);
      const double factor = pivot[k];
      for (int i = k; i <= below; ++i) right[i - k] -= factor * pivot[i];
    }
  }
}

void dpbtrs_(const char*, const int* n, const int* width, const int* columns, const double* band,
             const int* stride, double* right_sides, const int* right_stride, int* info) {
  *info = 0;
  for (int c = 0; c < *columns; ++c) {
    double* const x = right_sides + static_cast<std::ptrdiff_t>(c) * *right_stride;
    for (int j = 0; j < *n; ++j) {
      const double* const below = column(band, *stride, j);
      x[j] /= below[0];
      for (int i = 1; i <= std::min(*width, *n - 1 - j); ++i) x[j + i] -= below[i] * x[j];
    }
    for (int j = *n - 1; j >= 0; --j) {
      const double* const below = column(band, *stride, j);
      for (int i = 1; i <= std::min(*width, *n - 1 - j); ++i) x[j] -= below[i] * x[j + i];
      x[j] /= below[0];
    }
  }
}

}  // extern "C"
