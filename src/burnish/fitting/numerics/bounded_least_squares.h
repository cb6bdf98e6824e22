// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace burnish {

/// The values of m functions of n unknowns and, where asked for, their slopes.
struct LeastSquaresProblem {
  std::size_t functions;  ///< m
  /// Sets m values and, unless that span is empty, the m x n slopes row by row. Slopes are asked for only where
  /// values were asked for last.
  std::function<void(std::span<const double> x, std::span<double> values, std::span<double> slopes)> evaluate;
  std::vector<double> lower, upper;  ///< of each unknown, lower <= upper
};

struct LeastSquaresOptions {
  int max_iterations = 50;
  double tolerance = 1e-7;  ///< ends where a step lowers the sum by less than this part of it
  /// Least diagonal entry of the normal matrix where it is damped: unknowns that the functions hardly depend on move
  /// little.
  double least_diagonal = 1e-12;
};

struct LeastSquaresSolution {
  std::vector<double> x;    ///< within the bounds
  double first_cost, cost;  ///< half the sum of squares, at the start and at x
  int iterations;           ///< steps tried
  bool converged;           ///< false: max_iterations were not enough
};

/// Finds the least sum of squares near a start, by Levenberg-Marquardt steps with Nielsen's rule for the damping
/// (Nielsen1999 in docs/references.bib), projected on the bounds. Unknowns at a bound that the sum falls towards are
/// held.
/// It suits few unknowns and many functions: the n x n normal matrix is dense. The start is moved within the bounds.
/// Throws Error where a value at the start is not finite; steps to such values are refused.
LeastSquaresSolution solve_least_squares(const LeastSquaresProblem& problem, std::vector<double> start,
                                         const LeastSquaresOptions& options);

}  // namespace burnish
