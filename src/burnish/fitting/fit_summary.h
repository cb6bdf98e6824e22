// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace burnish {

/// Why a solver stopped.
enum class StopReason {
  /// A factorized system: no iteration was needed.
  direct_solution,
  /// Conjugate gradients: r^T M^-1 r <= tolerance^2 times what it was at the start, r being the residual and
  /// M the preconditioner.
  tolerance_reached,
  /// Gauss-Newton: before - after < least_progress in three steps in a row, before and after being the
  /// objective; or no damping gave a step with after < before.
  no_more_progress,
  /// Least squares of analytic models: |change of the cost| <= 1e-7 cost, the largest |derivative| <= 1e-10,
  /// or |step| <= 1e-8 |parameters|.
  converged,
  /// iterations >= the most that the options allow.
  iteration_limit,
};

/// "direct solution", "tolerance reached", "no more progress", "converged", "iteration limit".
std::string_view to_string(StopReason reason) noexcept;

/// The result of a solver. Each solver defines its error; all errors are finite.
struct FitSummary {
  double error_before = 0, error_after = 0;
  int iterations = 0;
  StopReason stop_reason = StopReason::iteration_limit;

  friend bool operator==(const FitSummary&, const FitSummary&) = default;
};

}  // namespace burnish
