#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using testing::random_model;
using testing::small_set;

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

TEST(NodeBand, SolvesWhatTheMatrixSolves) {
  const TrainingSet set = small_set(parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2"), 500);
  // all tables along theta_h, or another beside them
  for (const bool other : {false, true}) {
    std::string model = "z(h) v(theta_h,theta_d,phi_d) + y(h) w(theta_d,theta_h,phi_d)";
    std::vector<std::string> tables{"z=9", "v=5x4x3", "y=7,power:0.5", "w=4x6x3,identity,power:0.5"};
    if (other) {
      model += " p(wo) p(wi)";
      tables.emplace_back("p=5");
    }
    const LogModel log_model = random_model(model.c_str(), tables, 1);
    const Lookups lookups = lookups_of(log_model.spec, set);
    const RefineSystem system(log_model, set, lookups, {.exposure = 0.1}, TableFormat::half, 0, 1);
    ASSERT_TRUE(system.has_volume());
    const Eigen::VectorXd x = system.read(log_model);
    const ErrorTerms means = system.errors(x);
    RefineSystem::GaussNewton dense;
    system.gauss_newton_matrix(x, means, dense);
    Eigen::MatrixXd matrix = dense.matrix.selfadjointView<Eigen::Lower>();
    const Eigen::VectorXd extra = Eigen::VectorXd::Constant(x.size(), 1e-2 * matrix.diagonal().mean());
    matrix.diagonal() += extra;
    // what couples the band with the table beside it is left out
    const Eigen::Index rest = other ? 5 : 0;
    matrix.bottomLeftCorner(rest, x.size() - rest).setZero();
    matrix.topRightCorner(x.size() - rest, rest).setZero();
    NodeBand band = system.node_band();
    EXPECT_EQ(static_cast<Eigen::Index>(band.banded().size()), x.size() - rest);
    EXPECT_LT(band.band().width(), 120u);
    system.fill(x, means, 0, band);
    ASSERT_TRUE(band.factorize(extra));
    const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(x.size(), -1, 1);
    EXPECT_LT((band.solve(matrix * v) - v).norm(), 1e-3 * v.norm());

    // the roughness only adds to the matrix
    system.fill(x, means, 1, band);
    ASSERT_TRUE(band.factorize(extra));
    const Eigen::VectorXd solved = band.solve(v);
    EXPECT_GT(v.dot(solved), 0);
    Eigen::MatrixXd rough = matrix;
    system.add_roughness_matrix(1, rough);
    EXPECT_GE(v.dot(Eigen::VectorXd(rough.selfadjointView<Eigen::Lower>().llt().solve(v))),
              0.99 * v.dot(solved));
  }
}

}  // namespace
}  // namespace burnish
