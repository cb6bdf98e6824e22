// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/separable_brdf.h>
#include <burnish/error.h>
#include <burnish/fitting/baselines/pair_grid.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

using enum PairCoordinate;

TEST(PairGrid, HoldsTheSourceAtItsNodes) {
  const fixtures::Glossy source;
  const std::vector<NodeAxis> rows{{theta_h, 6}}, columns{{theta_d, 5}, {phi_d, 3}};
  const PairGrid grid = sample_pair_grid(source, rows, columns);
  ASSERT_EQ(grid.rows, 6u);
  ASSERT_EQ(grid.columns, 15u);
  std::vector<double> f(3);
  std::size_t measured = 0;
  for (std::size_t r = 0; r < grid.rows; ++r)
    for (std::size_t c = 0; c < grid.columns; ++c) {
      const std::array coordinates{theta_h, theta_d, phi_d};
      const std::array place{rows[0].node(static_cast<int>(r)), columns[0].node(static_cast<int>(c / 3)),
                             columns[1].node(static_cast<int>(c % 3))};
      const auto [wi, wo] = pair_at(coordinates, place).directions();
      EXPECT_EQ(grid.measured[r * 15 + c] != 0, std::min(wi.z, wo.z) >= kDrawnCosine);
      if (grid.measured[r * 15 + c] == 0) continue;
      ++measured;
      source.eval(wi, wo, f);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(grid.values[(r * 15 + c) * 3 + k], f[k] * separable_divisor(wi, wo), 1e-9);
    }
  EXPECT_GT(measured, 30u);
}

/// The lower of both cosines, as a grid stores it.
struct LowerCosine {
  static std::size_t channels() noexcept { return 1; }
  static bool isotropic() noexcept { return true; }
  static bool eval(Vec3 wi, Vec3 wo, std::span<double> f) noexcept {
    f[0] = std::min(wi.z, wo.z) / separable_divisor(wi, wo);
    return true;
  }
};

TEST(PairGrid, PullsNodesBelowTheHorizonJustAboveIt) {
  for (const PairCoordinate azimuth : {phi_d, turn_d}) {
    const PairGrid grid = sample_pair_grid(LowerCosine{}, std::vector<NodeAxis>{{theta_h, 12}},
                                           std::vector<NodeAxis>{{theta_d, 12}, {azimuth, 5}});
    std::size_t pulled = 0;
    for (std::size_t i = 0; i < grid.values.size(); ++i)
      if (grid.measured[i]) {
        EXPECT_GE(grid.values[i], kDrawnCosine);
      } else {
        EXPECT_NEAR(grid.values[i], kDrawnCosine, 1e-7);
        ++pulled;
      }
    EXPECT_GT(pulled, 100u);
  }
}

TEST(PairGrid, FillsHolesFromTheirNeighbours) {
  const fixtures::Glossy blind{.blind_below = 0.9};
  const PairGrid grid = sample_pair_grid(blind, std::vector<NodeAxis>{{theta_h, 6}},
                                         std::vector<NodeAxis>{{theta_d, 9}, {phi_d, 3}});
  for (const double value : grid.values) EXPECT_GT(value, 0);
  const fixtures::Glossy knows_nothing{.blind_below = 2};
  EXPECT_THROW(sample_pair_grid(knows_nothing, std::vector<NodeAxis>{{theta_h, 3}},
                                std::vector<NodeAxis>{{theta_d, 3}, {phi_d, 2}}),
               Error);
}

}  // namespace
}  // namespace burnish
