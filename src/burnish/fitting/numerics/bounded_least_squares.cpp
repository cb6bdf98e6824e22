// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <burnish/error.h>
#include <burnish/fitting/numerics/bounded_least_squares.h>

namespace burnish {

namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kFirstDamping = 1e-4;
constexpr double kMaxDamping = 1e16;  // steps that short change nothing

double half_square(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return sum / 2;
}

/// The current point: values, and a quadratic model of the sum of squares around x.
class State {
 public:
  State(const LeastSquaresProblem& problem, std::vector<double> start, double least_diagonal)
      : problem_(problem), least_diagonal_(least_diagonal), x_(std::move(start)), values_(problem.functions) {
    problem_.evaluate(x_, values_, {});
    cost_ = half_square(values_);
    if (!std::isfinite(cost_))
      throw Error("least squares: expected finite values at the start, found others");
  }

  const std::vector<double>& x() const { return x_; }
  double cost() const { return cost_; }

  /// Forms the model at x.
  void linearize() {
    RowMatrix slopes(values_.size(), x_.size());
    problem_.evaluate(x_, values_, {slopes.data(), static_cast<std::size_t>(slopes.size())});
    const Eigen::Map<const Eigen::VectorXd> values(values_.data(), static_cast<Eigen::Index>(values_.size()));
    // With slopes J and values r, the model has the matrix J^T J and the gradient J^T r.
    normal_ = slopes.transpose() * slopes;
    gradient_ = slopes.transpose() * values;
    // An unknown at a bound is held if the sum falls beyond it: its row, column and gradient become 0.
    for (Eigen::Index k = 0; k < gradient_.size(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      if ((x_[i] > problem_.lower[i] || gradient_[k] <= 0) &&
          (x_[i] < problem_.upper[i] || gradient_[k] >= 0))
        continue;
      normal_.row(k).setZero();
      normal_.col(k).setZero();
      gradient_[k] = 0;
    }
  }

  /// Returns the least point of the damped model within the bounds. Unknowns that would leave them go as far as they
  /// may, and the others are solved again, until all stay within.
  std::vector<double> step(double damping) const {
    // Marquardt's damping scales the diagonal, with a least value for unknowns that hardly matter.
    Eigen::MatrixXd damped = normal_;
    damped.diagonal() += damping * normal_.diagonal().cwiseMax(least_diagonal_);
    Eigen::VectorXd right = -gradient_;
    std::vector<double> to = x_;
    std::vector<bool> settled(x_.size(), false);
    for (bool again = true; again;) {
      again = false;
      const Eigen::VectorXd move = damped.llt().solve(right);
      for (std::size_t i = 0; i < to.size(); ++i) {
        if (settled[i]) continue;
        const auto k = static_cast<Eigen::Index>(i);
        to[i] = std::clamp(x_[i] + move[k], problem_.lower[i], problem_.upper[i]);
        if (to[i] == x_[i] + move[k]) continue;
        // A settled unknown's known move goes to the right side; its row and column become those of the identity.
        settled[i] = again = true;
        right -= damped.col(k) * (to[i] - x_[i]);
        damped.row(k).setZero();
        damped.col(k).setZero();
        damped(k, k) = 1;
        right[k] = 0;
      }
    }
    return to;
  }

  /// Returns the fall of the sum that the model predicts.
  double promised(const std::vector<double>& to) const {
    Eigen::VectorXd move(gradient_.size());
    for (Eigen::Index k = 0; k < move.size(); ++k)
      move[k] = to[static_cast<std::size_t>(k)] - x_[static_cast<std::size_t>(k)];
    return -gradient_.dot(move) - 0.5 * move.dot(normal_ * move);
  }

  /// Moves to a point if the sum is less there. Returns the gain, or 0.
  double go(std::vector<double> to) {
    std::vector<double> values(values_.size());
    problem_.evaluate(to, values, {});
    const double cost = half_square(values), gain = cost_ - cost;
    if (!(gain > 0)) return 0;
    x_ = std::move(to);
    values_ = std::move(values);
    cost_ = cost;
    return gain;
  }

 private:
  const LeastSquaresProblem& problem_;
  const double least_diagonal_;
  std::vector<double> x_, values_;
  double cost_ = 0;
  Eigen::MatrixXd normal_;
  Eigen::VectorXd gradient_;
};

}  // namespace

LeastSquaresSolution solve_least_squares(const LeastSquaresProblem& problem, std::vector<double> start,
                                         const LeastSquaresOptions& options) {
  for (std::size_t k = 0; k < start.size(); ++k)
    start[k] = std::clamp(start[k], problem.lower[k], problem.upper[k]);
  State state(problem, std::move(start), options.least_diagonal);
  LeastSquaresSolution solution{
      .x = {}, .first_cost = state.cost(), .cost = 0, .iterations = 0, .converged = false};
  double damping = kFirstDamping, rise = 2;
  bool moved = true;
  while (solution.iterations < options.max_iterations && !solution.converged) {
    if (moved) state.linearize();
    std::vector<double> to = state.step(damping);
    const double promised = state.promised(to), before = state.cost();
    ++solution.iterations;
    // The search ends where nothing is to be gained, or nothing that the numbers can tell.
    if (std::abs(promised) <= options.tolerance * 1e-3 * before || damping > kMaxDamping) {
      solution.converged = true;
      break;
    }
    const double gain = promised > 0 ? state.go(std::move(to)) : 0;
    moved = gain > 0;
    if (moved) {
      // Nielsen's rule: the better the prediction, the less damping, down to a third [Nielsen1999].
      const double quality = gain / promised;
      damping *= std::max(1.0 / 3, 1 - std::pow(2 * quality - 1, 3));
      rise = 2;
      solution.converged = gain < options.tolerance * before;
    } else {
      // After a failure the damping rises, twice as fast each time.
      damping *= rise;
      rise *= 2;
    }
  }
  solution.x = state.x();
  solution.cost = state.cost();
  return solution;
}

}  // namespace burnish
