// SeparableBrdf and DgfBrdf, what they promise as Brdfs.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/baseline_file.h>
#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/baselines.h>

namespace burnish {
namespace {

using fixtures::random_anisotropic;
using fixtures::random_dgf;
using fixtures::random_separable;
using fixtures::random_table;
using enum PairCoordinate;

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

TEST(DgfBrdf, IsTheProductOfItsFactorsOverADiffuseFloor) {
  const DgfBrdf brdf = random_dgf();
  std::vector<double> f(3);
  // at theta_h = 0 and theta_i = theta_o = theta_d, nodes of every table
  const Vec3 wi = spherical_direction(kHalfPi / 3, 0), wo = mirror(wi);
  const double cosine = wi.z;
  ASSERT_TRUE(brdf.eval(wi, wo, f));
  const double u = 1.0 / 3;
  const auto line = [&](const NodeTable& t, double at, std::size_t c) {
    const double x = at * (t.axes[0].count - 1);
    const auto i = static_cast<std::size_t>(x);
    const std::size_t channels = t.channels, k = channels == 1 ? 0 : c;
    return (1 - x + static_cast<double>(i)) * t.values[i * channels + k] +
           (x - static_cast<double>(i)) * t.values[(i + 1) * channels + k];
  };
  for (std::size_t c = 0; c < 3; ++c) {
    const double g = line(brdf.g(), u, c);
    EXPECT_NEAR(f[c],
                brdf.diffuse()[c] +
                    brdf.scale()[c] * line(brdf.d(), 0, c) * line(brdf.f(), u, c) * g * g / (cosine * cosine),
                1e-6);
  }
}

TEST(DgfBrdf, CountsBytes) {
  EXPECT_EQ(random_dgf().bytes(), 2u * (18 + 5 + 12) + 24);
}

TEST(DgfBrdf, RefusesTablesThatDoNotFit) {
  const NodeTable d = random_table({{theta_h, 4}}, 1, 1, 0, 1), g = random_table({{theta_d, 4}}, 1, 1, 0, 2);
  EXPECT_NO_THROW(DgfBrdf({1}, {1}, d, g, g));
  EXPECT_THROW(DgfBrdf({1}, {1, 1}, d, g, g), Error);
  EXPECT_THROW(DgfBrdf({}, {}, d, g, g), Error);
  EXPECT_THROW(DgfBrdf({-1}, {1}, d, g, g), Error);
  EXPECT_THROW(DgfBrdf({1}, {1}, g, g, g), Error);
  EXPECT_THROW(DgfBrdf({1}, {1}, d, d, g), Error);
  NodeTable negative = d;
  negative.values[0] = -1;
  EXPECT_THROW(DgfBrdf({1}, {1}, negative, g, g), Error);
  EXPECT_THROW(DgfBrdf({1}, {1}, d, g, random_table({{theta_d, 4}}, 1, 2, 0, 3)), Error);
}

}  // namespace
}  // namespace burnish
