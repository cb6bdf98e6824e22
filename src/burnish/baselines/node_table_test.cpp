// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/node_table.h>
#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

using enum PairCoordinate;

NodeTable small_table() {
  return {
      .axes = {{theta_h, 3}, {phi_d, 2}}, .channels = 3, .terms = 2, .values = std::vector<float>(36, 0.5f)};
}

TEST(NodeTable, InterpolatesWhatIsLinearInItsCoordinates) {
  NodeTable table{.axes = {{half_x, 9}, {half_y, 5}, {theta_d, 4}}, .channels = 1, .terms = 1, .values = {}};
  const auto plane = [](double x, double y, double d) { return 0.25 + 0.5 * x - 0.125 * y + 2 * d; };
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 4; ++k)
        table.values.push_back(
            static_cast<float>(plane(table.axes[0].node(i), table.axes[1].node(j), table.axes[2].node(k))));
  for (const auto& [wi, wo] : draw_pairs(300, 1, false)) {
    const PairPlace place(wi, wo);
    const NodeCorners at = corners(table.axes, place);
    EXPECT_EQ(at.count, 8u);
    EXPECT_NEAR(node_value(table, at, 0, 0), plane(place[half_x], place[half_y], place[theta_d]), 1e-6);
  }
}

TEST(NodeTable, GoesAroundPeriodicAxes) {
  const NodeTable table{.axes = {{turn_d, 4}}, .channels = 1, .terms = 1, .values = {0, 1, 2, 1}};
  EXPECT_EQ(table.axes[0].node(3), 0.75);
  for (const auto& [wi, wo] : draw_pairs(300, 2, false)) {
    const double u = PairPlace(wi, wo)[turn_d];
    EXPECT_NEAR(node_value(table, corners(table.axes, PairPlace(wi, wo)), 0, 0), 2 - 4 * std::abs(u - 0.5),
                1e-9);
  }
}

TEST(NodeTable, WeightsSumToOneAndNodesExist) {
  const NodeTable table = small_table();
  for (const auto& [wi, wo] : draw_pairs(300, 3, true)) {
    const NodeCorners at = corners(table.axes, PairPlace(wi, wo));
    double sum = 0;
    for (std::size_t k = 0; k < at.count; ++k) {
      EXPECT_LT(at.node[k], table.node_count());
      sum += at.weight[k];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(NodeTable, RefusesWhatDoesNotFit) {
  EXPECT_NO_THROW(check_node_table(small_table(), 3, "t"));
  const auto refused = [](auto change) {
    NodeTable table = small_table();
    change(table);
    EXPECT_THROW(check_node_table(table, 3, "t"), Error);
  };
  refused([](NodeTable& t) { t.axes.clear(); });
  refused([](NodeTable& t) { t.axes.assign(4, {theta_d, 2}); });
  refused([](NodeTable& t) { t.axes[0].count = 1; });
  refused([](NodeTable& t) { t.axes[0].count = 1 << 30; });
  refused([](NodeTable& t) { t.channels = 2; });
  refused([](NodeTable& t) { t.terms = 0; });
  refused([](NodeTable& t) { t.terms = -2; });
  refused([](NodeTable& t) { t.terms = 1 << 30; });
  refused([](NodeTable& t) { t.values.pop_back(); });
  refused([](NodeTable& t) { t.values[5] = std::numeric_limits<float>::quiet_NaN(); });
  refused([](NodeTable& t) { t.values[5] = 1e6f; });
  refused([](NodeTable& t) { t.values[5] = 0.1f; });  // no half float
}

TEST(NodeTable, RoundsToHalfFloats) {
  EXPECT_EQ(round_to_half(0.1), 0.0999755859375f);
  EXPECT_EQ(round_to_half(1e9), 65504.0f);
  EXPECT_EQ(round_to_half(-1e9), -65504.0f);
  Pcg32 random(4);
  for (int i = 0; i < 100; ++i) {
    const double x = std::exp(10 * random.uniform() - 5);
    EXPECT_NEAR(round_to_half(x), x, x * 0x1p-11);
  }
}

}  // namespace
}  // namespace burnish
