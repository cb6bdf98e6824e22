// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/separable_brdf.h>
#include <burnish/error.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/baselines.h>

namespace burnish {
namespace {

using fixtures::random_separable;
using fixtures::random_table;
using enum PairCoordinate;

TEST(SeparableBrdf, IsTheSumOfProductsOfItsTables) {
  const SeparableBrdf brdf = random_separable();
  std::vector<double> f(3);
  for (const auto& [wi, wo] : draw_pairs(200, 3, false)) {
    brdf.eval_signed(wi, wo, f);
    const PairPlace place(wi, wo);
    const NodeCorners in_u = corners(brdf.u().axes, place), in_v = corners(brdf.v().axes, place);
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < 2; ++k)
        sum += node_value(brdf.u(), in_u, c, k) * node_value(brdf.v(), in_v, 0, k);
      EXPECT_NEAR(f[c], brdf.scale()[c] * sum / std::sqrt(wi.z * wo.z), 1e-12 * (1 + std::abs(f[c])));
    }
  }
}

TEST(SeparableBrdf, CountsBytes) {
  // 3 channels of 7 nodes, one of 15, two terms, three scales
  EXPECT_EQ(random_separable().bytes(), 2u * 2 * (3 * 7 + 15) + 12);
}

TEST(SeparableBrdf, RefusesTablesThatDoNotBelongTogether) {
  const NodeTable u = random_table({{theta_h, 4}}, 3, 2, 0, 1), v = random_table({{theta_d, 4}}, 3, 2, 0, 2);
  EXPECT_NO_THROW(SeparableBrdf(u, v, {1, 1, 1}));
  EXPECT_THROW(SeparableBrdf(u, v, {}), Error);
  EXPECT_THROW(SeparableBrdf(u, v, {1, 1}), Error);
  EXPECT_THROW(SeparableBrdf(u, v, {1, 1, -1}), Error);
  EXPECT_THROW(SeparableBrdf(u, v, {1, 1, NAN}), Error);
  EXPECT_THROW(SeparableBrdf(u, u, {1, 1, 1}), Error);
  EXPECT_THROW(SeparableBrdf(u, random_table({{theta_d, 4}}, 3, 1, 0, 2), {1, 1, 1}), Error);
}

}  // namespace
}  // namespace burnish
