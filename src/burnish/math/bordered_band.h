#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace burnish {

/// A symmetric matrix of a band and a border: entries are 0 but next to the diagonal and in the last rows and columns.
/// Cholesky factorization keeps that shape [George 1981]; the factor's rows are stored, so that many entries of one are
/// computed side by side. Each is the same sum in the same order whatever the processor's vectors are.
class BorderedBand {
 public:
  /// Zero, of `count` + `border` rows; of the first `count` entries up to `band` from the diagonal are stored.
  BorderedBand(std::size_t count, std::size_t band, std::size_t border);

  std::size_t size() const noexcept { return count_ + border_; }
  /// An entry of the lower triangle. Precondition: column <= row < size(), row - column <= band where row < count.
  double& at(std::size_t row, std::size_t column) noexcept {
    if (row < count_) return *in_band(column, row);
    return column < count_ ? *beside(column, row - count_) : *in_corner(column - count_, row - count_);
  }

  /// Replaces the matrix by its Cholesky factor. Throws Error where it is not positive definite.
  void factor();
  /// Solves for one right side with the factor, in place. Precondition: factor() was called;
  /// right.size() == size().
  void solve(std::span<double> right) const noexcept;

 private:
  static constexpr std::size_t kRows = 4;   // that are computed together
  static constexpr std::size_t kTile = 16;  // entries of a row at most that are
  static constexpr std::size_t kFront = kRows - 1,
                               kBack = kRows + kTile;  // what such tiles reach beyond a row

  double* in_band(std::size_t row, std::size_t column) noexcept {
    return band_values_.data() + row * stride_ + kFront + (column - row);
  }
  const double* in_band(std::size_t row, std::size_t column) const noexcept {
    return band_values_.data() + row * stride_ + kFront + (column - row);
  }
  double* beside(std::size_t row, std::size_t column) noexcept {
    return border_values_.data() + row * border_stride_ + column;
  }
  const double* beside(std::size_t row, std::size_t column) const noexcept {
    return border_values_.data() + row * border_stride_ + column;
  }
  double* in_corner(std::size_t row, std::size_t column) noexcept {
    return corner_.data() + row * border_stride_ + column;
  }
  const double* in_corner(std::size_t row, std::size_t column) const noexcept {
    return corner_.data() + row * border_stride_ + column;
  }
  void finish_rows(std::size_t first);
  void finish_corner(std::size_t first);

  std::size_t count_, band_, border_, stride_, border_stride_;
  std::vector<double> band_values_, border_values_, corner_;  // upper triangles, row after row
};

}  // namespace burnish
