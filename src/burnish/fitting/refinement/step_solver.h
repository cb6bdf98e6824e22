// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <Eigen/Core>

#include <burnish/fitting/refinement/refine_system.h>

namespace burnish {

/// The objective's quadratic model about a point: slope and Gauss-Newton matrix, with the roughness.
class QuadraticModel {
 public:
  virtual ~QuadraticModel() = default;
  virtual void linearize(const Eigen::VectorXd& x, const ErrorTerms& means) = 0;
  const Eigen::VectorXd& gradient() const noexcept { return gradient_; }
  virtual Eigen::VectorXd diagonal() const = 0;
  /// Returns the matrix times v.
  virtual Eigen::VectorXd times(const Eigen::VectorXd& v) const = 0;
  /// Returns about -(matrix + diag(extra))^-1 gradient.
  virtual Eigen::VectorXd step(const Eigen::VectorXd& extra) = 0;
  /// The state that later steps take from earlier ones: IncompleteCholesky::share, or 0 where there is none.
  virtual double last_share() const { return 0; }
  virtual void set_last_share(double) {}

 protected:
  Eigen::VectorXd gradient_;
};

/// The damped linear systems of one channel, or of coupled channels.
class StepSolver {
 public:
  /// `system` must outlive it.
  StepSolver(const RefineSystem& system, double smooth);

  /// Returns true if steps are solved directly, not iteratively.
  bool is_direct() const noexcept { return direct_; }
  void linearize(const Eigen::VectorXd& x, const ErrorTerms& means) { model_->linearize(x, means); }
  /// Returns the change of the objective that the quadratic model of linearize predicts for a step.
  double predicted_change(const Eigen::VectorXd& dx) const {
    return dx.dot(model_->gradient() + 0.5 * model_->times(dx));
  }
  /// From now on, steps hold an unknown that is at a side of the box where its gradient leads out.
  void stay_within(const RefineSystem::Box& box, const Eigen::VectorXd& x);
  Eigen::VectorXd step(double damping);
  double last_share() const { return model_->last_share(); }
  void set_last_share(double share) { model_->set_last_share(share); }

 private:
  bool direct_;
  std::unique_ptr<QuadraticModel> model_;
  Eigen::Array<bool, Eigen::Dynamic, 1> held_;
};

}  // namespace burnish
