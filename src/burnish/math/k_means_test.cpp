// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/k_means.h>

namespace burnish {
namespace {

TEST(KMeans, FindsGroupsThatStandApart) {
  Points points{.size = 90, .coordinates = 2, .values = {}};
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto at = static_cast<double>(i);
    points.values.push_back(10.0 * static_cast<double>(i % 3) + std::sin(at));
    points.values.push_back((i % 3 == 1 ? -7 : 3) + std::cos(3 * at));
  }
  const Groups groups = grouped(points, 3);
  EXPECT_EQ(groups.sizes, (std::vector<std::size_t>{30, 30, 30}));
  for (std::size_t i = 0; i < points.size; ++i) EXPECT_EQ(groups.of[i], groups.of[i % 3]);
  for (std::size_t g = 0; g < 3; ++g) {
    const auto mean = groups.centres[groups.of[g]];
    EXPECT_NEAR(mean[0], 10.0 * static_cast<double>(g), 0.3);
  }
}

TEST(KMeans, LeavesGroupsEmptyWhereThereAreFewerPoints) {
  const Groups groups = grouped({.size = 2, .coordinates = 1, .values = {1, 2}}, 4);
  EXPECT_NE(groups.of[0], groups.of[1]);
  std::size_t sum = 0;
  for (const std::size_t size : groups.sizes) sum += size;
  EXPECT_EQ(sum, 2u);
}

}  // namespace
}  // namespace burnish
