// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/dgf_brdf.h>
#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/testing/baselines.h>

namespace burnish {
namespace {

using fixtures::random_dgf;
using fixtures::random_table;
using enum PairCoordinate;

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
