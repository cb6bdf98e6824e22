// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/fitting/refinement/albedo_term.h>
#include <burnish/math/random.h>
#include <burnish/metrics/albedo.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

/// Grey; +-1 by turns about a mean of 0.1, which cutting at zero makes 0.55.
struct Noise {
  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const bool above = wi.z > 0 && wo.z > 0;
    f[0] = above ? 0.1 + (static_cast<int>(std::floor(40 * wo.x)) % 2 == 0 ? 1 : -1) : 0;
    return true;
  }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const bool known = eval_raw(wi, wo, f);
    cut_negatives(f);
    return known;
  }
};

TEST(AlbedoSet, IsTheAlbedoOfRawValues) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.1,kd=0.2");
  const AlbedoSet set = albedo_set(ggx.ref());
  for (std::size_t k = 0; k < set.directions; ++k) {
    const Vec3 wi = set.pairs[k * set.points()].wi;
    const std::vector<double> expected = directional_albedo(ggx.ref(), wi).albedo;
    for (std::size_t c = 0; c < expected.size(); ++c)
      EXPECT_NEAR(set.targets[k * expected.size() + c] / expected[c], 1, 0.01) << wi.z;
  }
  const AlbedoSet noise = albedo_set(Noise{});
  EXPECT_NEAR(noise.targets.front(), 0.1 * kPi, 0.05 * kPi);
}

TEST(AlbedoSet, SumsOfAModelAreItsAlbedo) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2,kd=0.4");
  const AlbedoSet set = albedo_set(ggx.ref());
  std::vector<double> f(3);
  for (std::size_t k = 0; k < set.directions; ++k) {
    double sum = 0;
    for (std::size_t i = k * set.points(); i < (k + 1) * set.points(); ++i) {
      ggx.ref().eval(set.pairs[i].wi, set.pairs[i].wo, f);
      sum += static_cast<double>(set.weights[i]) * f[0];
    }
    EXPECT_NEAR(sum / static_cast<double>(set.targets[3 * k]), 1, 0.003) << k;
  }
}

TEST(AlbedoTerm, HasTheSlopesOfItsResiduals) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2,kd=0.1");
  const AlbedoSet set = albedo_set(ggx.ref());
  const LogModel model = fixtures::random_model("p(wo) p(wi) q(h) + a(theta_d)", {"p=5", "q=6", "a=4"}, 3);
  const Numbering numbering = number_nodes(model.spec, 1);
  std::vector<LobeLanes::NumberedTable> tables;
  for (std::size_t t = 0; t < model.spec.tables.size(); ++t)
    tables.push_back({numbering.tables[t], model.spec.tables[t].layout});
  const AlbedoTerm term(model.spec, tables, set, 3, 1, 1);
  ASSERT_EQ(term.size(), set.directions);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(15, -1, 0);
  const AlbedoTerm::Rows rows = term.rows(x);
  EXPECT_EQ(rows.residuals, term.residuals(x));
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Eigen::VectorXd up = x, down = x;
    up[k] += 1e-2;
    down[k] -= 1e-2;
    const Eigen::VectorXd slope = (term.residuals(up) - term.residuals(down)) / 2e-2;
    EXPECT_LT((rows.slopes.row(k).transpose() - slope).norm(), 1e-3 * rows.slopes.norm()) << k;
  }
}

}  // namespace
}  // namespace burnish
