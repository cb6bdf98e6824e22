// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <utility>

#include <burnish/fitting/numerics/dense.h>
#include <burnish/fitting/numerics/preconditioned_cg.h>
#include <burnish/fitting/refinement/refine.h>
#include <burnish/fitting/refinement/step_solver.h>

namespace burnish {

namespace {

// Ridges that fix what neither data nor smoothness determine, as shares of the mean diagonal.
constexpr double kStepRidge = 1e-7, kDampedRidge = 1e-3;
constexpr double kLongestStep = 2;  // change of a logarithm
constexpr double kHeld = 1e6;       // of the largest diagonal entry: what does not move

// A truncated solution is good enough for a step that is tried and judged.
constexpr int kMaxCgIterations = 40;
constexpr double kCgTolerance = 1e-2;

using Vector = Eigen::VectorXd;

template <class Apply, class Precondition>
Vector solve_iteratively(const Vector& b, const Apply& apply, const Precondition& precondition) {
  // Solves apply(x) = b by conjugate gradients from x = 0.
  Vector x = Vector::Zero(b.size());
  preconditioned_cg(
      x, b, kCgTolerance, kMaxCgIterations, apply, precondition,
      [](const Vector& a, const Vector& c) { return a.dot(c); }, [](const CgResult&) {});
  return x;
}

/// Forms the dense matrix and solves it by Cholesky. For few unknowns.
class DenseModel final : public QuadraticModel {
 public:
  DenseModel(const RefineSystem& system, double smooth) : system_(system), smooth_(smooth) {}

  void linearize(const Vector& x, const ErrorTerms& means) override {
    // Objective and smooth * roughness add up; the roughness x^T S x has the gradient 2 S x and the Hessian
    // 2 S.
    system_.gauss_newton_matrix(x, means, dense_);
    system_.add_roughness_matrix(2 * smooth_, dense_.matrix);
    gradient_ = dense_.gradient + 2 * smooth_ * system_.roughness_matrix_times(x);
  }
  Vector diagonal() const override { return dense_.matrix.diagonal(); }
  Vector times(const Vector& v) const override { return dense_.matrix.selfadjointView<Eigen::Lower>() * v; }
  Vector step(const Vector& extra) override {
    // The step solves (matrix + diag(extra)) dx = -gradient.
    factorized_ = dense_.matrix;
    factorized_.diagonal() += extra;
    Vector dx = -gradient_;
    solve_in_place(factorized_, dx);
    return dx;
  }

 private:
  const RefineSystem& system_;
  double smooth_;
  RefineSystem::GaussNewton dense_;
  Eigen::MatrixXd factorized_;
};

/// Multiplies with J and J^T and never forms the matrix. For many unknowns; models with volumes precondition
/// with a band of the matrix.
class FactorModel final : public QuadraticModel {
 public:
  FactorModel(const RefineSystem& system, double smooth)
      : system_(system), smooth_(smooth), roughness_diagonal_(2 * smooth * system.roughness_diagonal()) {
    if (system.has_volume()) band_ = system.node_band();
  }

  void linearize(const Vector& x, const ErrorTerms& means) override {
    // The slope adds the roughness's gradient. The point is kept, since the band is filled only when a step
    // is asked for.
    factor_ = system_.gauss_newton_factor(x, means);
    gradient_ = factor_.gradient + 2 * smooth_ * system_.roughness_matrix_times(x);
    x_ = x;
    means_ = means;
  }
  Vector diagonal() const override { return factor_.diagonal + roughness_diagonal_; }
  Vector times(const Vector& v) const override {
    return system_.gauss_newton_times(factor_, v) + 2 * smooth_ * system_.roughness_matrix_times(v);
  }
  Vector step(const Vector& extra) override {
    // The preconditioner is the factorized band, or the diagonal where there is no band or rounding made it
    // indefinite.
    bool banded = band_.has_value();
    if (banded) {
      system_.fill(x_, means_, 2 * smooth_, *band_);
      banded = band_->factorize(extra);
    }
    const Vector whole = diagonal() + extra;
    return solve_iteratively(
        -gradient_, [&](const Vector& v) -> Vector { return times(v) + extra.cwiseProduct(v); },
        [&](const Vector& r) -> Vector { return banded ? band_->solve(r) : r.cwiseQuotient(whole); });
  }

 private:
  const RefineSystem& system_;
  double smooth_;
  Vector roughness_diagonal_;
  RefineSystem::GaussNewtonFactor factor_;  // and what it was made at
  Vector x_;
  ErrorTerms means_;
  std::optional<NodeBand> band_;
};

/// Forms the matrix sparse; the albedos' part stays a product of few columns. For models with volumes.
class SparseModel final : public QuadraticModel {
 public:
  SparseModel(const RefineSystem& system, double smooth, SparseGram gram)
      : system_(system),
        smooth_(smooth),
        gram_(std::move(gram)),
        runs_(gram_.matrix()),
        order_(gram_.place().size()) {
    std::ranges::copy(gram_.place(), order_.indices().data());
  }

  void linearize(const Vector& x, const ErrorTerms& means) override {
    // The matrix's rows have an order of their own, so the albedos' rows are permuted to it. The gradient is
    // not.
    RefineSystem::SparseGaussNewton slope = system_.linearize(x, means, gram_);
    gradient_ = slope.gradient + 2 * smooth_ * system_.roughness_matrix_times(x);
    albedo_roots_ = order_ * slope.albedo_roots;
  }
  Vector diagonal() const override {
    return order_.transpose() * (gram_.matrix().diagonal() + Vector(albedo_roots_.rowwise().squaredNorm()));
  }
  Vector times(const Vector& v) const override { return order_.transpose() * ordered_times(order_ * v); }
  Vector step(const Vector& extra) override {
    // The damped matrix gets an incomplete Cholesky factor as preconditioner. Its diagonal share carries
    // over to the next step.
    const Vector ordered = order_ * extra;
    SparseTriangle damped = gram_.matrix();
    damped.diagonal() += ordered;
    const IncompleteCholesky factor(damped, share_, gram_.dense_rows());
    share_ = factor.share();
    return order_.transpose() *
           solve_iteratively(
               order_ * -gradient_,
               [&](const Vector& v) -> Vector { return ordered_times(v) + ordered.cwiseProduct(v); },
               [&](const Vector& r) -> Vector { return factor.solve(r); });
  }
  double last_share() const override { return share_; }
  void set_last_share(double share) override { share_ = share; }

 private:
  Vector ordered_times(const Vector& v) const {
    return symmetric_times(gram_.matrix(), runs_, v) + albedo_roots_ * (albedo_roots_.transpose() * v);
  }

  const RefineSystem& system_;
  double smooth_;
  SparseGram gram_;
  TriangleRuns runs_;                               ///< of the gram's matrix
  double share_ = 0;                                ///< of the last incomplete factor
  Eigen::PermutationMatrix<Eigen::Dynamic> order_;  ///< from the unknowns' to the matrix's
  Eigen::MatrixXd albedo_roots_;                    ///< in the matrix's order
};

}  // namespace

StepSolver::StepSolver(const RefineSystem& system, double smooth)
    : direct_(system.size() <= kMaxCholeskyUnknowns) {
  if (direct_)
    model_ = std::make_unique<DenseModel>(system, smooth);
  else if (std::optional<SparseGram> gram = system.sparse_gram(2 * smooth))
    model_ = std::make_unique<SparseModel>(system, smooth, *std::move(gram));
  else
    model_ = std::make_unique<FactorModel>(system, smooth);
}

void StepSolver::stay_within(const RefineSystem::Box& box, const Vector& x) {
  // An unknown is held where it is at a side of its box and the descent direction leads out.
  const Vector& slope = model_->gradient();
  held_ = (x.array() <= box.least.array() && slope.array() > 0) ||
          (x.array() >= box.most.array() && slope.array() < 0);
}

Vector StepSolver::step(double damping) {
  // Marquardt's damping scales the diagonal [Marquardt1963]. A ridge of the mean diagonal is added for what
  // nothing determines, and held unknowns get a diagonal so large that they do not move.
  const Vector diagonal = model_->diagonal();
  Vector extra = damping * diagonal.array() + (kStepRidge + damping * kDampedRidge) * diagonal.mean();
  for (Eigen::Index u = 0; u < held_.size(); ++u)
    if (held_[u]) extra[u] = kHeld * diagonal.maxCoeff();
  return model_->step(extra).cwiseMax(-kLongestStep).cwiseMin(kLongestStep);
}

}  // namespace burnish
