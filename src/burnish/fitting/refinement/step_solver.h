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
  /// The matrix times v.
  virtual Eigen::VectorXd times(const Eigen::VectorXd& v) const = 0;
  /// About -(matrix + extra)^-1 gradient, `extra` being added to the diagonal.
  virtual Eigen::VectorXd step(const Eigen::VectorXd& extra) = 0;
  /// What later steps take from earlier ones: IncompleteCholesky::share, 0 where there is none.
  virtual double last_share() const { return 0; }
  virtual void set_last_share(double) {}

 protected:
  Eigen::VectorXd gradient_;
};

/// One channel's, or coupled channels', damped linear systems.
class StepSolver {
 public:
  /// `system` must outlive it.
  StepSolver(const RefineSystem& system, double smooth);

  /// Whether steps are solved to the last digit.
  bool is_direct() const noexcept { return direct_; }
  void linearize(const Eigen::VectorXd& x, const ErrorTerms& means) { model_->linearize(x, means); }
  /// What the quadratic model of linearize says that a step adds to the objective.
  double predicted_change(const Eigen::VectorXd& dx) const {
    return dx.dot(model_->gradient() + 0.5 * model_->times(dx));
  }
  /// Steps from now on leave an unknown alone whose gradient leads out of the box at whose side it is.
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
