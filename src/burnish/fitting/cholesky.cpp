#include <mutex>

#include <burnish/fitting/cholesky.h>

// LAPACK has no header of its own.
extern "C" {
void dpotrf_(const char* triangle, const int* n, double* matrix, const int* stride, int* info);
void dpotri_(const char* triangle, const int* n, double* matrix, const int* stride, int* info);
void dpotrs_(const char* triangle, const int* n, const int* columns, const double* matrix, const int* stride,
             double* right_sides, const int* right_stride, int* info);
}

namespace burnish {

namespace {

// Builds of OpenBLAS without threads of their own need not bear calls from several.
std::mutex lapack;

}  // namespace

void solve_in_place(Eigen::MatrixXd& matrix, Eigen::VectorXd& x) {
  const int n = static_cast<int>(x.size()), one = 1;
  int info = 0;
  const std::lock_guard one_at_a_time(lapack);
  dpotrf_("L", &n, matrix.data(), &n, &info);
  if (info == 0) dpotrs_("L", &n, &one, matrix.data(), &n, x.data(), &n, &info);
  if (info != 0) x.setZero();
}

bool factorize_inverse(Eigen::MatrixXd& matrix) {
  const int n = static_cast<int>(matrix.rows());
  int info = 0;
  const std::lock_guard one_at_a_time(lapack);
  dpotrf_("L", &n, matrix.data(), &n, &info);
  if (info == 0) dpotri_("L", &n, matrix.data(), &n, &info);
  if (info != 0) return false;
  matrix.triangularView<Eigen::Upper>() = matrix.transpose().triangularView<Eigen::Upper>();
  dpotrf_("U", &n, matrix.data(), &n, &info);
  return info == 0;
}

}  // namespace burnish
