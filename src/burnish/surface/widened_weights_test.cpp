// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <gtest/gtest.h>

#include <burnish/surface/widened_weights.h>
#include <burnish/testing/surfaces.h>

namespace burnish {
namespace {

constexpr int kWide = 8, kHigh = 6;  // its levels are 4 x 3, 2 x 1, 1 x 1
constexpr std::array<WidenedLobe, 2> kCopies{{{.lobe = 0, .variance = 0.02}, {.lobe = 0, .variance = 0.2}}};

double texel_of(const SurfaceMap& map, int x, int y, std::size_t level, std::size_t channel = 0) {
  return static_cast<double>(map.texel(x, y, level)[channel]);
}

/// Returns the maps of a surface of two lobes, the second without copies.
SurfaceMaps two_lobes(SurfaceMap first, SurfaceMap normals) {
  SurfaceMap second = random_map(kWide, kHigh, 1, TableFormat::half, 1, 7);
  return {.weights = {std::move(first), std::move(second)}, .normals = std::move(normals), .tangents = {}};
}

template <class Visit>
void for_each_coarse_texel(const SurfaceMap& map, Visit visit) {
  for (std::size_t level = 1; level < map.levels(); ++level)
    for (int y = 0; y < map.level_height(level); ++y)
      for (int x = 0; x < map.level_width(level); ++x) visit(x, y, level);
}

TEST(WidenedWeights, ShareTheMeanWeight) {
  const SurfaceMaps own = two_lobes(random_map(kWide, kHigh, 3, TableFormat::half, 2, 1),
                                    random_vectors(kWide, kHigh, 0, 0.6, 2)),
                    maps = with_widened_weights(own, kCopies);
  ASSERT_EQ(maps.weights.size(), 4u);
  EXPECT_EQ(maps.weights[1], own.weights[1]);
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) {
      EXPECT_EQ(maps.weights[0].texel(x, y), own.weights[0].texel(x, y));
      for (const std::size_t copy : {2, 3}) EXPECT_EQ(maps.weights[copy].texel(x, y), SurfaceMap::Value{});
    }
  double shared = 0;
  // Shares are rounded to halves, the mean once in each level, up to three times.
  for_each_coarse_texel(own.weights[0], [&](int x, int y, std::size_t level) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double copies =
                       texel_of(maps.weights[2], x, y, level, c) + texel_of(maps.weights[3], x, y, level, c),
                   mean = texel_of(own.weights[0], x, y, level, c);
      EXPECT_NEAR(texel_of(maps.weights[0], x, y, level, c) + copies, mean, 4 * 0x1p-11 * mean);
      shared += copies;
    }
  });
  EXPECT_GT(shared, 1);
}

TEST(WidenedWeights, HaveTheVarianceOfTheNormals) {
  // Equal weights let every texel count alike.
  const SurfaceMap even(kWide, kHigh, 1, TableFormat::half, 1, std::vector<float>(kWide * kHigh, 0.75f)),
      normals = random_vectors(kWide, kHigh, 0, 0.6, 3);
  const SurfaceMaps maps = with_widened_weights(two_lobes(even, normals), kCopies);
  for_each_coarse_texel(even, [&](int x, int y, std::size_t level) {
    const int across = kWide / normals.level_width(level), down = kHigh / normals.level_height(level);
    double variance = 0;
    for (int j = 0; j < down; ++j)
      for (int i = 0; i < across; ++i)
        for (const std::size_t axis : {0, 1}) {
          const double off =
              texel_of(normals, across * x + i, down * y + j, 0, axis) - texel_of(normals, x, y, level, axis);
          variance += off * off / (2 * across * down);
        }
    ASSERT_LT(variance, kCopies[1].variance);
    double found = 0;
    for (const std::size_t copy : {0, 1})
      found += texel_of(maps.weights[2 + copy], x, y, level) * kCopies[copy].variance / 0.75;
    EXPECT_NEAR(found, variance, 0x1p-11 * variance) << x << " " << y << " " << level;
  });
}

// A texel counts by its weight. Normals of texels without weight may scatter about the mean.
TEST(WidenedWeights, StayWithTheLobeWhereItsNormalsAreOne) {
  std::vector<float> weights, normals;
  for (int i = 0; i < kWide * kHigh; ++i) {
    // Columns alternate between lit and dark. The dark ones are tilted to one side in even rows, to the other
    // in odd rows.
    const bool lit = i % 2 == 0;
    const float tilt = lit ? 0 : i / kWide % 2 == 0 ? 0.25f : -0.25f;
    weights.push_back(lit ? 1.0f : 0.0f);
    normals.insert(normals.end(), {0.125f + tilt, -0.25f});
  }
  const SurfaceMap map(kWide, kHigh, 1, TableFormat::half, 1, weights);
  const SurfaceMaps maps = with_widened_weights(
      two_lobes(map, SurfaceMap(kWide, kHigh, 2, TableFormat::half, 1, normals)), kCopies);
  EXPECT_EQ(maps.weights[0], map);
  for_each_coarse_texel(map, [&](int x, int y, std::size_t level) {
    for (const std::size_t copy : {2, 3}) EXPECT_EQ(texel_of(maps.weights[copy], x, y, level), 0);
  });
}

}  // namespace
}  // namespace burnish
