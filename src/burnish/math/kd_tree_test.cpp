// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/math/kd_tree.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

std::vector<TreePoint> some_points(std::size_t count) {
  Pcg32 random(7);
  std::vector<TreePoint> points(count);
  for (TreePoint& point : points)
    for (double& x : point) x = random.uniform();
  return points;
}

TEST(KdTree, FindsTheNearestPointsThatASearchFinds) {
  const std::vector<TreePoint> points = some_points(500), centres = some_points(540);
  const KdTree tree(points);
  for (std::size_t c = 500; c < centres.size(); ++c) {
    std::vector<std::pair<double, std::size_t>> expected;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (i % 3 != 0) expected.emplace_back(distance2(points[i], centres[c]), i);
    std::ranges::sort(expected);
    std::vector<KdTree::Neighbour> found(12);
    const std::size_t count =
        tree.nearest(centres[c], found, [&](std::size_t place) { return tree.order()[place] % 3 != 0; });
    ASSERT_EQ(count, 12u);
    std::sort(found.begin(), found.end());
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(tree.order()[found[i].place], expected[i].second);
  }
}

TEST(KdTree, VisitsWhatLiesInABall) {
  const std::vector<TreePoint> points = some_points(300);
  const KdTree tree(points);
  const TreePoint centre{0.5, 0.5, 0.5, 0.5};
  std::vector<std::size_t> found, expected;
  tree.visit_ball(centre, 0.1, [&](std::size_t place, double) { found.push_back(tree.order()[place]); });
  for (std::size_t i = 0; i < points.size(); ++i)
    if (distance2(points[i], centre) <= 0.1) expected.push_back(i);
  std::ranges::sort(found);
  EXPECT_EQ(found, expected);
  EXPECT_FALSE(expected.empty());
}

TEST(KdTree, FindsAllOfFewPoints) {
  const KdTree tree(some_points(3));
  std::vector<KdTree::Neighbour> found(5);
  EXPECT_EQ(tree.nearest({0, 0, 0, 0}, found, [](std::size_t) { return true; }), 3u);
}

}  // namespace
}  // namespace burnish
