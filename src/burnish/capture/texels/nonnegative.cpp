// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/capture/texels/nonnegative.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

namespace {

/// Finds the least of w' a w / 2 - b' w with w >= 0: unknowns are set free one by one [LawsonHanson1974].
class ActiveSet {
 public:
  ActiveSet(std::span<const double> a, std::span<const double> b, std::span<double> w) noexcept
      : a_(a), b_(b), w_(w), n_(b.size()) {}

  /// Starts with the unknowns of w free that are not 0.
  void start_near() noexcept {
    for (std::size_t i = 0; i < n_; ++i) free_[i] = w_[i] > 0;
    settle();
  }

  void run() noexcept {
    while (changes_ < 3 * n_) {
      const std::size_t next = steepest();
      if (next == n_) return;
      free_[next] = true;
      settle();
    }
  }

 private:
  static constexpr double kMinSquare = 1e-300, kMinSlope = 1e-12;

  /// Returns the unknown at 0 along which the sum falls fastest; n_ if there is none.
  std::size_t steepest() const noexcept {
    std::size_t best = n_;
    double most = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      if (free_[i]) continue;
      // The sum falls by b - A w where w grows. This is divided by the root of the unknown's own square.
      double slope = b_[i];
      for (std::size_t j = 0; j < n_; ++j) slope -= a_[i * n_ + j] * w_[j];
      const double scaled = slope / std::sqrt(std::max(a_[i * n_ + i], kMinSquare));
      if (scaled > most && slope > kMinSlope * std::abs(b_[i])) {
        most = scaled;
        best = i;
      }
    }
    return best;
  }

  /// Finds the minimum over the free unknowns, by Cholesky.
  void solve_free() noexcept {
    std::size_t m = 0;
    for (std::size_t i = 0; i < n_; ++i)
      if (free_[i]) member_[m++] = i;
    // The free unknowns' matrix is L L^T. Each row of L is found together with its element of y, where L y = b.
    for (std::size_t i = 0; i < m; ++i) {
      double rest = b_[member_[i]];
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = a_[member_[i] * n_ + member_[j]];
        for (std::size_t k = 0; k < j; ++k) sum -= factor_[i][k] * factor_[j][k];
        factor_[i][j] = i == j ? std::sqrt(std::max(sum, kMinSquare)) : sum * inverse_[j];
      }
      inverse_[i] = 1 / factor_[i][i];
      for (std::size_t k = 0; k < i; ++k) rest -= factor_[i][k] * solution_[member_[k]];
      solution_[member_[i]] = rest * inverse_[i];
    }
    // Then L^T x = y is solved from the last unknown to the first.
    for (std::size_t i = m; i-- > 0;) {
      double rest = solution_[member_[i]];
      for (std::size_t k = i + 1; k < m; ++k) rest -= factor_[k][i] * solution_[member_[k]];
      solution_[member_[i]] = rest * inverse_[i];
    }
  }

  /// Moves w to the solution for the free unknowns as far as all stay positive. Fixes at 0 the unknown that would
  /// not, and repeats.
  void settle() noexcept {
    while (changes_ < 3 * n_) {
      ++changes_;
      solve_free();
      // The step from w to the solution ends where the first unknown would become negative.
      double step = 1;
      std::size_t blocking = n_;
      for (std::size_t i = 0; i < n_; ++i)
        if (free_[i] && solution_[i] <= 0) {
          const double share = w_[i] > solution_[i] ? w_[i] / (w_[i] - solution_[i]) : 0;
          if (share < step || blocking == n_) {
            step = share;
            blocking = i;
          }
        }
      for (std::size_t i = 0; i < n_; ++i)
        if (free_[i]) w_[i] += step * (solution_[i] - w_[i]);
      // This unknown is fixed at 0, and the other unknowns are solved for again.
      if (blocking == n_) break;
      free_[blocking] = false;
      w_[blocking] = 0;
    }
  }

  static constexpr std::size_t kMax = kMaxSurfaceLobes;
  std::span<const double> a_, b_;
  std::span<double> w_;
  std::size_t n_, changes_ = 0;
  std::array<bool, kMax> free_{};
  std::array<double, kMax> solution_{};
  std::array<std::array<double, kMax>, kMax> factor_;
  std::array<double, kMax> inverse_;  // inverse diagonal of the factor
  std::array<std::size_t, kMax> member_;
};

}  // namespace

void solve_nonnegative(std::span<const double> a, std::span<const double> b, std::span<double> w,
                       bool near) noexcept {
  const auto finite = [](double value) { return std::isfinite(value); };
  const bool sound = std::ranges::all_of(b, finite) && std::ranges::all_of(a, finite);
  if (!near || !sound) std::ranges::fill(w, 0.0);
  if (!sound) return;
  ActiveSet set(a, b, w);
  if (near) set.start_near();
  set.run();
}

}  // namespace burnish
