// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/format.h>

#include <burnish/fitting/numerics/dense.h>
#include <burnish/fitting/numerics/lapack_lock.h>
#include <burnish/fitting/numerics/linear_algebra.h>

// LAPACK and BLAS as Fortran knows them have no header of their own.
extern "C" {
void dpotrf_(const char* triangle, const int* n, double* matrix, const int* stride, int* info);
void dtrtri_(const char* triangle, const char* diagonal, const int* n, double* matrix, const int* stride,
             int* info);
void dpotrs_(const char* triangle, const int* n, const int* columns, const double* matrix, const int* stride,
             double* right_sides, const int* right_stride, int* info);
void dsyrk_(const char* triangle, const char* transpose, const int* n, const int* inner, const double* scale,
            const double* matrix, const int* stride, const double* keep, double* result,
            const int* result_stride);
void ilaver_(int* major, int* minor, int* patch);
}

namespace burnish {

namespace {

// A matrix that lies row by row is, column by column, its transpose.
Eigen::MatrixXd products(const char* transpose, Eigen::Index size, Eigen::Index inner,
                         const Eigen::Ref<const RowMajorMatrix>& a) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  const int n = static_cast<int>(size), terms = static_cast<int>(inner),
            stride = static_cast<int>(a.outerStride());
  const double one = 1, zero = 0;
  const std::lock_guard one_at_a_time(lapack_mutex());
  dsyrk_("L", transpose, &n, &terms, &one, a.data(), &stride, &zero, result.data(), &n);
  return result;
}

}  // namespace

std::string linear_algebra() {
  int major = 0, minor = 0, patch = 0;
  ilaver_(&major, &minor, &patch);
  return major == 0 ? "Eigen in place of LAPACK" : fmt::format("LAPACK {}.{}.{}", major, minor, patch);
}

std::mutex& lapack_mutex() {
  static std::mutex mutex;
  return mutex;
}

void solve_in_place(Eigen::MatrixXd& matrix, Eigen::VectorXd& x) {
  const int n = static_cast<int>(x.size()), one = 1;
  int info = 0;
  const std::lock_guard one_at_a_time(lapack_mutex());
  dpotrf_("L", &n, matrix.data(), &n, &info);
  if (info == 0) dpotrs_("L", &n, &one, matrix.data(), &n, x.data(), &n, &info);
  if (info != 0) x.setZero();
}

bool factorize_inverse(Eigen::MatrixXd& matrix) {
  // With P that reverses the order and P A P = L L^T, the inverse of A is U^T U where U = P L^-1 P: no need
  // to make the inverse.
  const int n = static_cast<int>(matrix.rows());
  int info = 0;
  for (Eigen::Index c = 0; c < matrix.cols(); ++c)
    for (Eigen::Index r = matrix.rows() - 1 - c; r >= c; --r)
      std::swap(matrix(r, c), matrix(matrix.rows() - 1 - c, matrix.rows() - 1 - r));
  const std::lock_guard one_at_a_time(lapack_mutex());
  dpotrf_("L", &n, matrix.data(), &n, &info);
  if (info == 0) dtrtri_("L", "N", &n, matrix.data(), &n, &info);
  matrix.reverseInPlace();
  return info == 0;
}

Eigen::MatrixXd products_of_rows(const Eigen::Ref<const RowMajorMatrix>& a) {
  return products("T", a.rows(), a.cols(), a);
}

Eigen::MatrixXd products_of_columns(const Eigen::Ref<const RowMajorMatrix>& a) {
  return products("N", a.cols(), a.rows(), a);
}

}  // namespace burnish
