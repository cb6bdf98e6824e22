// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::random_model;
using fixtures::small_set;

TEST(NodeBand, SolvesWhatTheMatrixSolves) {
  const TrainingSet drawn = small_set(parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2"), 500);
  // all tables along theta_h, or another beside them; pairs as drawn, or those of a cell together
  for (const auto& [other, ordered] : {std::pair(false, false), {true, false}, {false, true}, {true, true}}) {
    std::string model = "z(h) v(theta_h,theta_d,phi_d) + y(h) w(theta_d,theta_h,phi_d)";
    std::vector<std::string> tables{"z=9", "v=5x4x3", "y=7,power:0.5", "w=4x6x3,identity,power:0.5"};
    if (other) {
      model += " p(wo) p(wi)";
      tables.emplace_back("p=5");
    }
    const LogModel log_model = random_model(model.c_str(), tables, 1);
    const TrainingSet set = ordered ? ordered_by_cells(drawn, log_model.spec) : drawn;
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
