// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/reflectance/tensor_tree.h>

namespace burnish {
namespace {

// SDdisk2square of Radiance's bsdf_m.c, by its four regions.
DiskPoint radiance_square(double x, double y) {
  const double quarter = kPi / 4, r = std::hypot(x, y);
  double phi = std::atan2(y, x), a, b;
  if (phi < -quarter) phi += kTwoPi;
  if (phi < quarter) {
    a = r;
    b = phi * a / quarter;
  } else if (phi < 3 * quarter) {
    b = r;
    a = -(phi - kHalfPi) * b / quarter;
  } else if (phi < 5 * quarter) {
    a = -r;
    b = (phi - kPi) * a / quarter;
  } else {
    b = -r;
    a = -(phi - 3 * kHalfPi) * b / quarter;
  }
  return {(a + 1) / 2, (b + 1) / 2};
}

TEST(TensorTree, MapsDiskAndSquareAsRadianceDoes) {
  Pcg32 random(1);
  for (int i = 0; i < 1000; ++i) {
    const double r = std::sqrt(random.uniform()), phi = kTwoPi * random.uniform();
    const DiskPoint disk{r * std::cos(phi), r * std::sin(phi)};
    const DiskPoint square = shirley_chiu_square(disk), expected = radiance_square(disk.x, disk.y);
    EXPECT_NEAR(square.x, expected.x, 1e-14);
    EXPECT_NEAR(square.y, expected.y, 1e-14);
    const DiskPoint back = shirley_chiu_disk(square);
    EXPECT_NEAR(back.x, disk.x, 1e-14);
    EXPECT_NEAR(back.y, disk.y, 1e-14);
  }
  EXPECT_EQ(shirley_chiu_square({0, 0}).x, 0.5);
  EXPECT_EQ(shirley_chiu_disk({0.5, 0.5}).y, 0);
}

TEST(TensorTree, LooksUpTheLeafThatHoldsAPair) {
  for (const int rank : {3, 4}) {
    const std::size_t count = std::size_t{1} << rank;
    TensorTree tree{.rank = rank, .nodes = {{-1, 0}}, .links = {}, .values = {}};
    // the first child a grid, the others single values
    for (std::size_t child = 0; child < count; ++child) {
      tree.links.push_back(static_cast<std::uint32_t>(child + 1));
      tree.nodes.push_back({child == 0 ? 1 : 0, static_cast<std::uint32_t>(tree.values.size())});
      for (std::size_t k = 0; k < (child == 0 ? count : 1); ++k)
        tree.values.push_back(static_cast<float>(tree.values.size() + 1));
    }
    const std::vector<TreeLeaf> all = leaves(tree);
    EXPECT_EQ(all.size(), rank == 4 ? 31u : 8u + 3u);
    for (const TreeLeaf& leaf : all) {
      const auto [wi, wo] = leaf_directions(tree, leaf);
      double f;
      tree.eval(wi, wo, {&f, 1});
      EXPECT_EQ(f, static_cast<double>(leaf.value));
      if (rank == 4) continue;
      // turned about the normal
      const auto turned = [](Vec3 w) { return Vec3{-w.y, w.x, w.z}; };
      tree.eval(turned(wi), turned(wo), {&f, 1});
      EXPECT_EQ(f, static_cast<double>(leaf.value));
    }
  }
}

TEST(TensorTree, EdgesOfCubesDoNotFeelRounding) {
  Pcg32 random(2);
  // cubes of the tree's second and third level, no two values alike
  TensorTree tree{.rank = 4, .nodes = {{-1, 0}}, .links = {}, .values = {}};
  for (std::uint32_t child = 0; child < 16; ++child) {
    tree.links.push_back(child + 1);
    tree.nodes.push_back({child % 2 ? 2 : 1, static_cast<std::uint32_t>(tree.values.size())});
    for (int k = 0; k < (child % 2 ? 256 : 16); ++k)
      tree.values.push_back(static_cast<float>(tree.values.size() + 1));
  }
  for (int i = 0; i < 1000; ++i) {
    // a corner of cubes
    std::array<double, 4> at;
    for (double& x : at) x = std::floor(1 + 7 * random.uniform()) / 8;
    const auto [wi, wo] = leaf_directions(tree, {.centre = at, .size = 0.125, .value = 0});
    const auto rounded = [&](Vec3 w) {
      for (double* x : {&w.x, &w.y}) *x += 3e-16 * (random.uniform() - 0.5);
      return w;
    };
    double f, g;
    tree.eval(wi, wo, {&f, 1});
    tree.eval(rounded(wi), rounded(wo), {&g, 1});
    EXPECT_EQ(f, g) << at[0] << ' ' << at[1] << ' ' << at[2] << ' ' << at[3];
  }
}

TEST(TensorTree, IsMadeOfASourceAtItsCentres) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.4,alpha_y=0.6,f0=0.5");
  struct Green {
    BrdfRef source;
    std::size_t channels() const noexcept { return 1; }
    bool isotropic() const noexcept { return source.isotropic(); }
    bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
      std::array<double, 3> rgb;
      source.eval(wi, wo, rgb);
      f[0] = rgb[1];
      return true;
    }
  };
  const Green green{ggx.ref()};
  const TensorTree exact = tabulate_tree(green, 3, 0), coarse = tabulate_tree(green, 3, 0.3);
  EXPECT_LT(coarse.values.size(), exact.values.size());
  for (const TreeLeaf& leaf : leaves(exact)) {
    const auto [wi, wo] = leaf_directions(exact, leaf);
    double f, g;
    green.eval(wi, wo, {&f, 1});
    EXPECT_NEAR(static_cast<double>(leaf.value), f, 1e-6 * f);
    coarse.eval(wi, wo, {&g, 1});
    EXPECT_NEAR(g, f, 0.31 / 0.7 * f);
  }
  // Weights of the nodes are measures of their cubes.
  const MeasuredNodes nodes = measured_nodes(exact);
  EXPECT_EQ(nodes.size(), 4096u);
  for (const double weight : nodes.weights) EXPECT_NEAR(weight, 1, 1e-12);
}

}  // namespace
}  // namespace burnish
