#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace burnish {

/// A symmetric matrix of which each row is stored from its first entry that is not zero up to the diagonal:
/// bands, and bands with a border of full rows. Cholesky factorization keeps that shape [George1981].
class EnvelopeMatrix {
 public:
  /// Zero. first[i] <= i is the first column stored of row i.
  explicit EnvelopeMatrix(std::vector<std::size_t> first);

  std::size_t size() const noexcept { return first_.size(); }
  /// An entry of the lower triangle. Precondition: first[row] <= column <= row < size().
  double& at(std::size_t row, std::size_t column) noexcept {
    return values_[begin_[row] + column - first_[row]];
  }

  /// Replaces the matrix by its Cholesky factor. Throws Error where it is not positive definite.
  void factor();
  /// Solves for one right side with the factor, in place. Precondition: factor() was called;
  /// right.size() == size().
  void solve(std::span<double> right) const noexcept;

 private:
  const double* row(std::size_t i) const noexcept { return values_.data() + begin_[i]; }

  std::vector<std::size_t> first_, begin_;
  std::vector<double> values_;
};

}  // namespace burnish
