// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <burnish/fitting/refinement/refine.h>
#include <burnish/fitting/refinement/step_solver.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::random_model;
using fixtures::small_set;

constexpr double kRoughly = 1e-3;  // how much smoothness counts

/// A model of one channel, and what its steps are found with.
struct StepCase {
  TrainingSet set;
  LogModel model;
  Lookups lookups;
  PictureLoss loss{.exposure = 0.1};
  RefineSystem system;
  Eigen::VectorXd x;
  ErrorTerms means;
  StepSolver solver;

  StepCase(const std::string& expression, const std::vector<std::string>& tables)
      : set(small_set(parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3"), 400)),
        model(random_model(expression, tables, 1)),
        lookups(lookups_of(model.spec, set)),
        system(model, set, lookups, loss, TableFormat::single, 0, 1),
        x(system.read(model)),
        means(system.errors(x)),
        solver(system, kRoughly) {
    solver.linearize(x, means);
  }

  double objective(const Eigen::VectorXd& at) const {
    return loss.objective(system.errors(at)) + kRoughly * system.roughness(at);
  }
  /// The quadratic model's matrix and slope, as they are defined.
  RefineSystem::GaussNewton defined() const {
    RefineSystem::GaussNewton dense;
    system.gauss_newton_matrix(x, means, dense);
    system.add_roughness_matrix(2 * kRoughly, dense.matrix);
    dense.matrix = Eigen::MatrixXd(dense.matrix.selfadjointView<Eigen::Lower>());
    dense.gradient += 2 * kRoughly * system.roughness_matrix_times(x);
    return dense;
  }
};

/// Solved directly; by a sparse matrix; by its factor, without and with a band.
const std::pair<const char*, std::vector<std::string>> kStepCases[] = {
    {"p(wo) p(wi) q(h)", {"p=5", "q=7x7"}},
    {"v(theta_h,theta_d,phi_d) z(h)", {"v=12x11x8", "z=23"}},
    {"p(wo) p(wi) q(h)", {"p=5", "q=33x33"}},
    {"z(h) v(theta_h,theta_d,phi_d) + a(h) b(h) c(h) d(h) e(h) f(h) + i(h) j(h) k(h) l(h) m(h) n(h)",
     {"z=5", "v=12x11x8", "a=4", "b=4", "c=4", "d=4", "e=4", "f=4", "i=4", "j=4", "k=4", "l=4", "m=4",
      "n=4"}}};

TEST(StepSolver, ModelIsTheObjectiveToSecondOrder) {
  for (const auto& [expression, tables] : kStepCases) {
    const StepCase test(expression, tables);
    const RefineSystem::GaussNewton defined = test.defined();
    EXPECT_EQ(test.solver.is_direct(), test.x.size() <= static_cast<Eigen::Index>(kMaxCholeskyUnknowns));
    const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(test.x.size(), 0, 1000).array().sin();
    const double slope = defined.gradient.dot(v), bend = v.dot(defined.matrix * v);
    // sums of floats, as in RefineSystem's own test
    EXPECT_NEAR(test.solver.predicted_change(v), slope + bend / 2,
                1e-5 * (defined.gradient.norm() * v.norm() + bend))
        << expression;
    constexpr double kStep = 1e-3;
    EXPECT_NEAR(test.solver.predicted_change(kStep * v) - test.solver.predicted_change(-kStep * v),
                test.objective(test.x + kStep * v) - test.objective(test.x - kStep * v),
                1e-3 * 2 * kStep * defined.gradient.norm() * v.norm())
        << expression;
  }
}

// (matrix + damping diagonal + ridge) dx = -gradient. Solved directly it lacks but the least ridge, 1e-7 of the mean
// diagonal; conjugate gradients end where r^T M^-1 r is 1e-4 of the first, which damping keeps near the error.
TEST(StepSolver, StepsGoToTheLeastOfTheDampedModel) {
  for (const auto& [expression, tables] : kStepCases) {
    StepCase test(expression, tables);
    const RefineSystem::GaussNewton defined = test.defined();
    double longest = 0;
    for (const double damping : {0.1, 10.0, 1000.0}) {
      Eigen::MatrixXd damped = defined.matrix;
      damped.diagonal() += damping * defined.matrix.diagonal();
      damped.diagonal().array() += damping * 1e-3 * defined.matrix.diagonal().mean();
      const Eigen::VectorXd least = -Eigen::LLT<Eigen::MatrixXd>(damped).solve(defined.gradient),
                            step = test.solver.step(damping);
      if (least.cwiseAbs().maxCoeff() < 2) {  // steps are no longer
        const Eigen::VectorXd off = step - least;
        EXPECT_LT(off.dot(damped * off), (test.solver.is_direct() ? 1e-10 : 1e-2) * least.dot(damped * least))
            << expression << " " << damping;
        longest = std::max(longest, least.norm());
      }
      EXPECT_LE(step.cwiseAbs().maxCoeff(), 2);
      EXPECT_LT(test.solver.predicted_change(step), 0) << expression << " " << damping;
    }
    EXPECT_GT(longest, 0) << expression;
  }
}

TEST(StepSolver, LeavesAloneWhatWouldLeaveTheBox) {
  for (const auto& [expression, tables] : kStepCases) {
    StepCase test(expression, tables);
    const RefineSystem::GaussNewton defined = test.defined();
    // unknowns by turns at the upper side, at the lower, and inside
    RefineSystem::Box box{.least = test.x.array() - 1, .most = test.x.array() + 1};
    for (Eigen::Index u = 0; u < test.x.size(); ++u) {
      if (u % 3 == 0) box.most[u] = test.x[u];
      if (u % 3 == 1) box.least[u] = test.x[u];
    }
    test.solver.stay_within(box, test.x);
    const Eigen::VectorXd step = test.solver.step(0.1);
    double inward = 0;
    for (Eigen::Index u = 0; u < test.x.size(); ++u) {
      const double slope = defined.gradient[u];
      if ((u % 3 == 0 && slope < 0) || (u % 3 == 1 && slope > 0)) {
        EXPECT_LT(std::abs(step[u]), 1e-5) << expression << " " << u;
      } else {
        inward = std::max(inward, std::abs(step[u]));
      }
    }
    EXPECT_GT(inward, 1e-2) << expression;
  }
}

}  // namespace
}  // namespace burnish
