// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace burnish {

/// A symmetric matrix of numbers within `width` of the diagonal, and its Cholesky factor. By LAPACK.
class BandMatrix {
 public:
  BandMatrix() = default;
  BandMatrix(std::size_t size, std::size_t width) : size_(size), width_(width), lower_(size * (width + 1)) {}

  std::size_t size() const noexcept { return size_; }
  std::size_t width() const noexcept { return width_; }
  /// Returns the entry of a row and a column at or before it, at most width() apart.
  double& operator()(std::size_t row, std::size_t column) noexcept {
    return lower_[column * (width_ + 1) + row - column];
  }
  void set_zero();

  /// Replaces a positive definite matrix by its factor; false where rounding made it indefinite, and what it
  /// holds is meaningless.
  bool factorize();
  /// Returns matrix^-1 b, after factorize().
  Eigen::VectorXd solve(Eigen::VectorXd b) const;
  /// Given the changes of unknowns i + 1 and after, returns the change of unknown i that minimizes v^T matrix v, with
  /// the unknowns before i free. Call it from the last unknown to the first, after factorize().
  double follow(std::size_t i, const Eigen::VectorXd& changes) const noexcept;

 private:
  std::size_t size_ = 0, width_ = 0;
  std::vector<double> lower_;  ///< column by column, each from the diagonal on
};

}  // namespace burnish
