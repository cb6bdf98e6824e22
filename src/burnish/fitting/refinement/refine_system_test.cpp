// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::random_model;
using fixtures::small_set;

TEST(RefineSystem, MatrixAndFactorAreTheSameSystem) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2");
  TrainingSet set = small_set(ggx, 500);
  const std::string different = "p(wo) p(wi) q(h) + q(h) g(theta_d,theta_m)";
  // tables of one layout, more of them than a vector has lanes
  const std::string alike = "p(wo) p(wi) q(h) g(theta_d,theta_m) + a(wo) b(h) c(theta_d,theta_m)",
                    volumes = "z(h) v(theta_h,theta_d,phi_d) + z(h) p(wo) p(wi) w(theta_d,theta_h,phi_d)",
                    many = "a(h) b(h) + c(h) d(wo) + e(h) f(h) + g(h) i(h) + j(h) k(h)";
  const struct {
    std::string expression;
    std::vector<std::string> tables;
    std::size_t unknowns;
  } cases[] = {
      {different, {"p=5", "q=9", "g=4x3"}, 5 + 9 + 12},
      {different, {"p=5,shared", "q=9", "g=4x3"}, 5 + 3 * 9 + 3 * 12},
      {alike, {"p=5", "a=5", "q=5", "b=5", "g=4x3", "c=4x3"}, 4 * 5 + 2 * 12},
      {alike, {"p=5,shared", "a=5", "q=5", "b=5", "g=4x3,shared", "c=4x3"}, 5 + 3 * 15 + 12 + 3 * 12},
      {many, {"a=5", "b=5", "c=5", "d=5", "e=5", "f=5", "g=5", "i=5", "j=5", "k=5"}, 50},
      {volumes, {"z=9", "v=5x4x3", "p=5", "w=4x5x3"}, 9 + 60 + 5 + 60},
      {volumes, {"z=9,shared", "v=5x4x3", "p=5", "w=4x5x3,shared"}, 9 + 3 * 60 + 3 * 5 + 60}};
  for (const auto& [expression, tables, unknowns] : cases) {
    const LogModel model = random_model(expression.c_str(), tables, 3);
    const bool shared = model.any_shared();
    const Lookups lookups = lookups_of(model.spec, set);
    // albedos count in every second; no pixel is white
    set.albedo = unknowns % 2 == 0 ? albedo_set(ggx) : AlbedoSet{};
    PictureLoss loss{.exposure = 0.1};
    loss.shares.albedo = 0.3;
    const RefineSystem system(model, set, lookups, loss, TableFormat::half, shared ? 0 : 1, shared ? 3 : 2);
    const Eigen::VectorXd x = system.read(model);
    ASSERT_EQ(static_cast<std::size_t>(x.size()), unknowns);
    const ErrorTerms means = system.errors(x);
    RefineSystem::GaussNewton dense;
    system.gauss_newton_matrix(x, means, dense);
    const Eigen::MatrixXd matrix = dense.matrix.selfadjointView<Eigen::Lower>();
    const RefineSystem::GaussNewtonFactor factor = system.gauss_newton_factor(x, means);
    const double size = matrix.norm();
    EXPECT_LT((factor.gradient - dense.gradient).norm(), 1e-5 * dense.gradient.norm());
    Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(x.size(), -1, 1);
    EXPECT_LT((system.gauss_newton_times(factor, v) - matrix * v).norm(), 1e-5 * size * v.norm());
    Eigen::MatrixXd roughness = Eigen::MatrixXd::Zero(x.size(), x.size());
    system.add_roughness_matrix(1, roughness);
    EXPECT_NEAR(v.dot(roughness * v), system.roughness(v), 1e-9 * system.roughness(v));
    EXPECT_LT((roughness * v - system.roughness_matrix_times(v)).norm(), 1e-9 * roughness.norm() * v.norm());
    EXPECT_LT((roughness.diagonal() - system.roughness_diagonal()).norm(), 1e-9 * roughness.norm());
    // and the gradient is that of the objective
    for (const Eigen::Index k : {Eigen::Index{2}, x.size() - 3}) {
      Eigen::VectorXd up = x, down = x;
      up[k] += 1e-3;
      down[k] -= 1e-3;
      EXPECT_NEAR(dense.gradient[k],
                  (loss.objective(system.errors(up)) - loss.objective(system.errors(down))) / 2e-3,
                  1e-3 * dense.gradient.cwiseAbs().maxCoeff());
    }
  }
}

}  // namespace
}  // namespace burnish
