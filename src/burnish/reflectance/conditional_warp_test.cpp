// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/conditional_warp.h>

namespace burnish {
namespace {

constexpr int kWidth = 9, kHeight = 6;

std::vector<float> random_density(std::uint64_t seed, int slices) {
  Pcg32 random(seed);
  std::vector<float> density;
  for (int i = 0; i < slices * kWidth * kHeight; ++i)
    density.push_back(static_cast<float>(std::pow(random.uniform(), 4) + 1e-3));
  return density;
}

const SliceMix kSecond{{1}, {1}, 1};
const SliceMix kFour{{0, 1, 2, 3}, {0.1, 0.2, 0.3, 0.4}, 4};

TEST(ConditionalWarp2, InvertsItsOwnWarp) {
  const ConditionalWarp2 warp(kWidth, kHeight, random_density(1, 4));
  Pcg32 random(2);
  for (const SliceMix& mix : {kSecond, kFour})
    for (int i = 0; i < 2000; ++i) {
      const Point2 u{random.uniform(), random.uniform()};
      const Point2 back = warp.invert(warp.warp(u, mix), mix);
      EXPECT_NEAR(back.x, u.x, 1e-5);
      EXPECT_NEAR(back.y, u.y, 1e-5);
    }
}

TEST(ConditionalWarp2, KeepsTheCornersOfTheSquare) {
  const ConditionalWarp2 warp(kWidth, kHeight, random_density(3, 4));
  for (double x : {0.0, 1.0})
    for (double y : {0.0, 1.0}) {
      const Point2 there = warp.warp({x, y}, kFour), back = warp.invert({x, y}, kFour);
      EXPECT_NEAR(there.x, x, 1e-5);
      EXPECT_NEAR(there.y, y, 1e-5);
      EXPECT_NEAR(back.x, x, 1e-6);
      EXPECT_NEAR(back.y, y, 1e-6);
    }
}

TEST(ConditionalWarp2, JacobianOfTheInverseIsTheDensity) {
  const ConditionalWarp2 warp(kWidth, kHeight, random_density(4, 4));
  Pcg32 random(5);
  for (int i = 0; i < 500; ++i) {
    // Away from cell borders, where the density has kinks.
    const auto inside = [&](int n) {
      return (std::floor(random.uniform() * (n - 1)) + 0.1 + 0.8 * random.uniform()) / (n - 1);
    };
    const double x = inside(kWidth), y = inside(kHeight), e = 1e-3;
    // x of the result depends on both coordinates, y on y alone.
    const double du = warp.invert({x + e, y}, kFour).x - warp.invert({x - e, y}, kFour).x;
    const double dv = warp.invert({x, y + e}, kFour).y - warp.invert({x, y - e}, kFour).y;
    const double density = warp.pdf({x, y}, kFour);
    EXPECT_NEAR(du * dv / (4 * e * e), density, 0.002 + 0.002 * density);
  }
}

TEST(ConditionalWarp2, DensityIntegratesToOne) {
  const ConditionalWarp2 warp(kWidth, kHeight, random_density(6, 4));
  double sum = 0;
  constexpr int kSteps = 8 * (kWidth - 1) * (kHeight - 1);  // whole steps in every cell: the sum is exact
  for (int y = 0; y < kSteps; ++y)
    for (int x = 0; x < kSteps; ++x) sum += warp.pdf({(x + 0.5) / kSteps, (y + 0.5) / kSteps}, kFour);
  EXPECT_NEAR(sum / kSteps / kSteps, 1, 1e-6);
}

TEST(ConditionalWarp2, EmptyRowsAndCellsStayInsideTheSquare) {
  std::vector<float> density(kWidth * kHeight, 0.0f);
  density[2 * kWidth + 4] = 1;
  const ConditionalWarp2 warp(kWidth, kHeight, density);
  const SliceMix first{{0}, {1}, 1};
  for (double x = 0; x <= 1; x += 0.125)
    for (double y = 0; y <= 1; y += 0.125)
      for (const Point2 p : {warp.warp({x, y}, first), warp.invert({x, y}, first)}) {
        EXPECT_TRUE(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1) << p.x << ' ' << p.y;
      }
}

TEST(ConditionalWarp2, BadDensitiesThrow) {
  const auto make = [](int width, int height, std::vector<float> density) {
    return ConditionalWarp2(width, height, density);
  };
  EXPECT_NO_THROW(make(2, 2, {0, 0, 0, 1}));
  EXPECT_THROW(make(1, 4, {1, 1, 1, 1}), Error);
  EXPECT_THROW(make(4, 1, {1, 1, 1, 1}), Error);
  EXPECT_THROW(make(2, 2, {}), Error);
  EXPECT_THROW(make(2, 2, {1, 1, 1, 1, 1}), Error);
  EXPECT_THROW(make(2, 2, {0, 0, 0, 0}), Error);
  EXPECT_THROW(make(2, 2, {1, 1, 1, 1, 0, 0, 0, 0}), Error);
  EXPECT_THROW(make(2, 2, {1, -1, 1, 1}), Error);
  EXPECT_THROW(make(2, 2, {1, NAN, 1, 1}), Error);
  EXPECT_THROW(make(2, 2, {1, INFINITY, 1, 1}), Error);
}

}  // namespace
}  // namespace burnish
