// SPDX-License-Identifier: Apache-2.0
// SeparableBrdf and DgfBrdf, what they promise as Brdfs.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/baseline_file.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/baselines.h>

namespace burnish {
namespace {

using fixtures::random_anisotropic;
using fixtures::random_dgf;
using fixtures::random_separable;

std::vector<DirectionPair> pairs_and_corners() {
  std::vector<DirectionPair> pairs = draw_pairs(300, 1, false);
  pairs.push_back({{0, 0, 1}, {0, 0, 1}});
  pairs.push_back({{0.6, 0, 0.8}, {0.6, 0, 0.8}});
  pairs.push_back({{0.6, 0, 0.8}, {-0.6, 0, 0.8}});
  pairs.push_back({normalize({1, 0, 1e-9}), normalize({-1, 0, 1e-9})});
  pairs.push_back({normalize({1, 0, 1e-9}), normalize({1, 1e-9, 1e-9})});
  pairs.push_back({normalize({0, 1, 1e-5}), {0, 0, 1}});
  return pairs;
}

class BaselineBrdfs : public ::testing::TestWithParam<BaselineBrdf> {};

TEST_P(BaselineBrdfs, AreFinitePositiveAndReciprocalToTheLastBit) {
  const BrdfRef brdf = baseline_ref(GetParam());
  std::vector<double> f(3), swapped(3);
  for (const auto& [wi, wo] : pairs_and_corners()) {
    ASSERT_TRUE(brdf.eval(wi, wo, f));
    ASSERT_TRUE(brdf.eval(wo, wi, swapped));
    EXPECT_EQ(f, swapped);
    for (const double value : f) EXPECT_TRUE(std::isfinite(value) && value >= 0) << value;
  }
}

TEST_P(BaselineBrdfs, AreBlackBelowTheHorizon) {
  std::vector<double> f{1, 1, 1};
  EXPECT_TRUE(baseline_ref(GetParam()).eval({0.6, 0, -0.8}, {0, 0, 1}, f));
  EXPECT_EQ(f, std::vector<double>(3));
}

TEST_P(BaselineBrdfs, IgnoreRotationWhereIsotropic) {
  const BrdfRef brdf = baseline_ref(GetParam());
  if (!brdf.isotropic()) return;
  std::vector<double> f(3), turned(3);
  const auto turn = [](Vec3 w) { return Vec3{0.6 * w.x - 0.8 * w.y, 0.8 * w.x + 0.6 * w.y, w.z}; };
  for (const auto& [wi, wo] : draw_pairs(200, 2, false)) {
    brdf.eval(wi, wo, f);
    brdf.eval(turn(wi), turn(wo), turned);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], turned[c], 1e-7 * (1 + f[c]));
  }
}

INSTANTIATE_TEST_SUITE_P(All, BaselineBrdfs,
                         ::testing::Values(BaselineBrdf(random_separable()),
                                           BaselineBrdf(random_anisotropic()), BaselineBrdf(random_dgf())));

}  // namespace
}  // namespace burnish
