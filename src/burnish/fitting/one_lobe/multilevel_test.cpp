// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/one_lobe/multilevel.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

TEST(GridTransfer, RestrictionIsTheTransposeOfInterpolation) {
  const TableLayout grid{.shape = TableShape::grid, .width = 9, .height = 6},
      volume{.shape = TableShape::volume, .width = 9, .height = 6, .depth = 5};
  Pcg32 random(1);
  constexpr std::size_t kStep = 3;
  for (const TableLayout& layout : {grid, volume})
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
