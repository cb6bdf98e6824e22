#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/numerics/smoothness.h>
#include <burnish/fitting/one_lobe/multilevel.h>
#include <burnish/math/random.h>

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

TEST(Smoothness, IsTheSameAtEveryResolution) {
  const auto f = [](double x, double) { return std::cos(3 * x); };
  const double coarse = roughness({.width = 60}, f), fine = roughness({.width = 240}, f);
  EXPECT_NEAR(coarse, fine, 0.05 * fine);
}

TEST(Smoothness, ConstantsAreFree) {
  for (const TableLayout& layout :
       {TableLayout{.width = 7}, TableLayout{.shape = TableShape::disk, .width = 5, .height = 5},
        TableLayout{.shape = TableShape::grid, .width = 4, .height = 6}})
    EXPECT_NEAR(roughness(layout, [](double, double) { return 3.0; }), 0, 1e-20);
}

TEST(GridTransfer, RestrictionIsTheTransposeOfInterpolation) {
  const TableLayout layout{.shape = TableShape::grid, .width = 9, .height = 6};
  Pcg32 random(1);
  constexpr std::size_t kStep = 3;
  for (const GridTransfer& level : coarser_levels(layout)) {
    std::vector<double> fine(layout.node_count() * kStep), coarse(level.coarse_count() * kStep);
    for (double& v : fine) v = random.uniform();
    for (double& v : coarse) v = random.uniform();
    std::vector<double> restricted(coarse.size()), interpolated(fine.size());
    level.restrict_to(fine.data(), restricted.data(), kStep);
    level.add_interpolated(coarse.data(), interpolated.data(), kStep);
    double a = 0, b = 0;
    for (std::size_t i = 0; i < coarse.size(); ++i) a += restricted[i] * coarse[i];
    for (std::size_t i = 0; i < fine.size(); ++i) b += interpolated[i] * fine[i];
    EXPECT_NEAR(a, b, 1e-12 * std::abs(a));
  }
}

TEST(GridTransfer, InterpolatesLinearFunctionsExactlyDownToTwoNodes) {
  const TableLayout layout{.width = 17};
  for (const GridTransfer& level : coarser_levels(layout)) {
    if (level.coarse_width() < 2) continue;
    std::vector<double> coarse, fine(17);
    for (int i = 0; i < level.coarse_width(); ++i)
      coarse.push_back(static_cast<double>(i) / (level.coarse_width() - 1));
    level.add_interpolated(coarse.data(), fine.data(), 1);
    for (int i = 0; i < 17; ++i) EXPECT_NEAR(fine[static_cast<std::size_t>(i)], i / 16.0, 1e-14);
  }
}

}  // namespace
}  // namespace burnish
