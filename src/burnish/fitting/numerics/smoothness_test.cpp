// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/numerics/smoothness.h>

namespace burnish {
namespace {

// Sum of the squared rows for node values f(x, y) over the unit square.
template <class F>
double roughness(const TableLayout& layout, const F& f) {
  const SmoothnessRows rows = smoothness_rows(layout);
  double sum = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    double value = 0;
    for (std::size_t k = rows.starts[r]; k < rows.starts[r + 1]; ++k) {
      const int node = static_cast<int>(rows.nodes[k]);
      value += rows.coefficients[k] *
               f(static_cast<double>(node % layout.width) / (layout.width - 1),
                 layout.height > 1 ? static_cast<double>(node / layout.width) / (layout.height - 1) : 0);
    }
    sum += value * value;
  }
  return sum;
}

TEST(Smoothness, ApproachesTheIntegralOfSecondDerivatives) {
  // f = x^2 y: f_xx = 2 y, f_xy = 2 x, f_x = 2 x y, f_y = x^2; integrals over the unit square
  const double exact = 4.0 / 3 + 2 * 4.0 / 3 + kSlopeShare * (4.0 / 9 + 1.0 / 5);
  const TableLayout fine{.shape = TableShape::disk, .width = 200, .height = 200};
  EXPECT_NEAR(roughness(fine, [](double x, double y) { return x * x * y; }), exact, 0.03 * exact);
}

TEST(Smoothness, CountsEveryAxisOfAVolume) {
  // f = x y z: f_xy^2 = z^2 and so on, f_x^2 = y^2 z^2
  const auto along = [](int node, int nodes) { return static_cast<double>(node) / (nodes - 1); };
  const TableLayout layout{.shape = TableShape::volume, .width = 40, .height = 30, .depth = 50};
  const SmoothnessRows rows = smoothness_rows(layout);
  double sum = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    double value = 0;
    for (std::size_t k = rows.starts[r]; k < rows.starts[r + 1]; ++k) {
      const int node = static_cast<int>(rows.nodes[k]), row = node / layout.width;
      value += rows.coefficients[k] * along(node % layout.width, layout.width) *
               along(row % layout.height, layout.height) * along(row / layout.height, layout.depth);
    }
    sum += value * value;
  }
  const double exact = 2 * 3 * (1.0 / 3) + kVolumeSlopeShare * 3 * (1.0 / 9);
  EXPECT_NEAR(sum, exact, 0.1 * exact);  // sums over nodes, not cells, along the other axes
}

TEST(Smoothness, KnowsWhereAGridsAnglesBegin) {
  const TableLayout layout{.shape = TableShape::grid, .width = 9, .height = 7};
  const auto rows = [&](TableEdges edges) { return smoothness_rows(layout, edges).size(); };
  EXPECT_EQ(rows({.even_y = true}), rows({}) + 9);
  EXPECT_EQ(rows({.pole_x = true}), rows({}) + 7 + 6);
  // differences along a pole are as good as forbidden
  const SmoothnessRows pole = smoothness_rows(layout, {.pole_x = true});
  const auto roughness_of = [&](std::size_t node) {
    double sum = 0;
    for (std::size_t k = 0; k < pole.nodes.size(); ++k)
      if (pole.nodes[k] == node) sum += pole.coefficients[k] * pole.coefficients[k];
    return sum;
  };
  EXPECT_GT(roughness_of(3 * 9), 1000 * roughness_of(3 * 9 + 4));
}

TEST(Smoothness, TiesBothEndsOfACircle) {
  const TableLayout layout{.shape = TableShape::volume, .width = 4, .height = 3, .depth = 6};
  EXPECT_EQ(smoothness_rows(layout, {.circle_z = true}).size(), smoothness_rows(layout).size() + 4 * 3);
}

TEST(Smoothness, IsTheSameAtEveryResolution) {
  const auto f = [](double x, double) { return std::cos(3 * x); };
  const double coarse = roughness({.width = 60}, f), fine = roughness({.width = 240}, f);
  EXPECT_NEAR(coarse, fine, 0.05 * fine);
}

TEST(Smoothness, ConstantsAreFree) {
  for (const TableLayout& layout :
       {TableLayout{.width = 7}, TableLayout{.shape = TableShape::disk, .width = 5, .height = 5},
        TableLayout{.shape = TableShape::grid, .width = 4, .height = 6},
        TableLayout{.shape = TableShape::volume, .width = 4, .height = 6, .depth = 3}})
    EXPECT_NEAR(roughness(layout, [](double, double) { return 3.0; }), 0, 1e-20);
}

}  // namespace
}  // namespace burnish
