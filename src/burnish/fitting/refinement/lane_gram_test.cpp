// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/fitting/refinement/lane_gram.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>

namespace burnish {
namespace {

// Families of three, two and one table, one of all lobes, grids, a volume, and unknowns of which some are left out.
TEST(LaneGram, IsTheProductOfTheDenseMatrix) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3");
  const TrainingSet set = draw_training_set(ggx.ref(), {.pictures = 200, .directions = 200});
  const std::vector<std::string> sizes{"p=5", "a=5", "c=5", "q=7", "b=7", "g=4x3", "d=4x3", "z=9", "v=3x4x2"};
  const ModelSpec spec = parse_model_spec(
      "p(wo) p(wi) q(h) g(theta_d,theta_m) z(h) + a(wo) a(wi) b(h) z(h) + c(wo) c(wi) d(theta_d,theta_m) "
      "z(h) v(theta_h,theta_d,phi_d)",
      sizes, true);
  const Numbering numbering = number_nodes(spec, 1);
  const std::size_t size = numbering.count;
  std::vector<LobeLanes::NumberedTable> tables;
  for (std::size_t t = 0; t < spec.tables.size(); ++t)
    tables.push_back({numbering.tables[t], spec.tables[t].layout});
  const Lookups lookups = lookups_of(spec, set);
  const LobeLanes lanes(tables, lookups, 1);
  Pcg32 random(5);
  Eigen::VectorXd x(static_cast<Eigen::Index>(size));
  for (double& v : x) v = random.uniform();
  const LobeLanes::Values values = lanes.values(x);

  // Row by row what add_transposed adds, whose slopes are those of the total.
  const std::size_t first = tables[1].number.base, count = size - first;
  LaneRows rows;
  rows.layout(lanes, first, size, set.size());
  LaneRows odd;
  odd.layout(lanes, first, size, 7);
  for (const LaneRows::Piece& piece : odd.pieces) EXPECT_EQ(piece.start % 16, 0u);  // loaded as whole vectors
  Eigen::MatrixXd dense(static_cast<Eigen::Index>(set.size()), x.size());
  LobeLanes::Block at = lanes.block();
  for (std::size_t i = 0; i < set.size(); ++i) {
    const std::size_t block = i / LobeLanes::kBlock;
    lanes.evaluate(values, block, 0, at);
    lanes.differentiate(at);
    const float root = static_cast<float>(random.uniform());
    std::vector<float> amounts(LobeLanes::kBlock);
    amounts[i % LobeLanes::kBlock] = root;
    AlignedVector<float> sums(values.lambdas.size());
    lanes.add_transposed(at, amounts.data(), block, 0, sums);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(x.size());
    lanes.gather(sums, row);
    dense.row(static_cast<Eigen::Index>(i)) = row.cwiseProduct(values.lambda);
    rows.set(lanes, i, 0, i, at, root);
  }
  const auto kept = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Constant(2, 2, 7);  // of another step
  for (int again = 0; again < 2; ++again) {
    scaled_gram(rows, values.lambda.tail(kept), gram);
    const Eigen::MatrixXd part = dense.rightCols(kept), expected = part.transpose() * part;
    const Eigen::MatrixXd found = gram.selfadjointView<Eigen::Lower>();
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-5 * expected.maxCoeff());
  }
}

}  // namespace
}  // namespace burnish
