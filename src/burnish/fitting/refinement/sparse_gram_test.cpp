// SPDX-License-Identifier: Apache-2.0
#include <Eigen/SparseCore>
#include <gtest/gtest.h>

#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::random_model;
using fixtures::small_set;

TEST(SparseGram, IsTheMatrix) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2");
  TrainingSet set = small_set(ggx, 500);
  const struct {
    const char* model;
    std::vector<std::string> tables;
  } cases[] = {
      {"z(h) v(theta_h,theta_d,phi_d)", {"z=23", "v=5x4x3"}},
      {"v(theta_h,theta_d,phi_d) z(theta_d)", {"v=4x5x3,power:0.5", "z=3"}},
      {"v(theta_d,theta_h,phi_d)", {"v=5x4x3"}},
      {"p(wo) p(wi) v(theta_h,theta_d,phi_d) q(h)", {"p=5x5", "v=3x4x3", "q=9x9"}},
      {"z(h) p(wo) p(wi) k(theta_m,theta_d) v(theta_h,theta_d,phi_d)", {"z=9", "p=7", "k=3x4", "v=3x4x3"}},
      {"z(h) v(theta_h,theta_d,phi_d) + z(h) p(wo) p(wi) v(theta_d,theta_h,phi_d) + c(theta_d)",
       {"z=9", "v=4x4x3", "p=5", "c=4"}}};
  for (const auto& [expression, tables] : cases) {
    const LogModel model = random_model(expression, tables, 1);
    const Lookups lookups = lookups_of(model.spec, set);
    set.albedo = tables.size() == 1 ? albedo_set(ggx) : AlbedoSet{};
    PictureLoss loss{.exposure = 0.1};
    loss.shares.albedo = 0.3;
    const RefineSystem system(model, set, lookups, loss, TableFormat::half, 0, 1);
    const Eigen::VectorXd x = system.read(model);
    const ErrorTerms means = system.errors(x);
    RefineSystem::GaussNewton dense;
    system.gauss_newton_matrix(x, means, dense);
    system.add_roughness_matrix(0.5, dense.matrix);
    const Eigen::MatrixXd matrix = dense.matrix.selfadjointView<Eigen::Lower>();

    std::optional<SparseGram> gram = system.sparse_gram(0.5);
    ASSERT_TRUE(gram) << expression;
    Eigen::PermutationMatrix<Eigen::Dynamic> order(x.size());
    std::ranges::copy(gram->place(), order.indices().data());
    for (int again = 0; again < 2; ++again) {  // nothing is left of the first time
      const RefineSystem::SparseGaussNewton sparse = system.linearize(x, means, *gram);
      EXPECT_LT((sparse.gradient - dense.gradient).norm(), 1e-5 * dense.gradient.norm()) << expression;
      const Eigen::MatrixXd ordered = gram->matrix().toDense().selfadjointView<Eigen::Lower>();
      const Eigen::MatrixXd found = order.transpose() * ordered * order;
      const Eigen::MatrixXd whole = found + sparse.albedo_roots * sparse.albedo_roots.transpose();
      EXPECT_LT((whole - matrix).norm(), 1e-5 * matrix.norm()) << expression;
    }
  }
}

TEST(SparseGram, IsOfModelsWithVolumesAndFewLookups) {
  const TrainingSet set = small_set(parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2"), 50);
  for (const auto& [expression, tables] : std::vector<std::pair<const char*, std::vector<std::string>>>{
           {"z(h) g(theta_d,theta_m)", {"z=5", "g=5x4"}},
           {"z(h) v(theta_h,theta_d,phi_d) + a(h) b(h) c(h) d(h) e(h) f(h) + i(h) j(h) k(h) l(h) m(h) n(h)",
            {"z=5", "v=5x4x3", "a=4", "b=4", "c=4", "d=4", "e=4", "f=4", "i=4", "j=4", "k=4", "l=4", "m=4",
             "n=4"}}}) {
    const LogModel model = random_model(expression, tables, 1);
    const Lookups lookups = lookups_of(model.spec, set);
    const RefineSystem system(model, set, lookups, {.exposure = 0.1}, TableFormat::half, 0, 1);
    EXPECT_FALSE(system.sparse_gram(0)) << expression;
  }
}

}  // namespace
}  // namespace burnish
