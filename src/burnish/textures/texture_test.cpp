// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/textures/texture.h>

namespace burnish {
namespace {

Table table_of(TableShape shape, int width, int height, Warp warp, double (*value)(double x, double y),
               int depth = 1) {
  Table table{
      .name = "t", .layout = {shape, width, height, depth, warp, warp, warp}, .channels = 3, .values = {}};
  for (int row = 0; row < height * depth; ++row)
    for (int x = 0, y = row % height; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        table.values.push_back(
            static_cast<float>(value(static_cast<double>(x) / (width - 1),
                                     height == 1 ? 0.5 : static_cast<double>(y) / (height - 1)) /
                               (1 + c)));
  return table;
}
double smooth(double x, double y) {
  return 0.55 + 0.3 * std::sin(3 * x + 1) * std::cos(2 * y);
}

const FactorUse kUse{.table = 0, .projection = kProjectWo, .projection_y = kProjectWi};

// The factor's value for a direction, first channel.
double lookup(const Table& table, Vec3 w, Vec3 w_y) {
  const Lookup at = locate(table.layout, kUse, w_y, w);
  const auto node = [&](int dx, int dy) {
    const int i = at.node + dx + (dy ? table.layout.width : 0);
    return static_cast<double>(table.values[static_cast<std::size_t>(3 * i)]);
  };
  const double low = node(0, 0) + at.fx * (node(1, 0) - node(0, 0));
  if (table.layout.shape == TableShape::line) return low;
  return low + at.fy * (node(0, 1) + at.fx * (node(1, 1) - node(0, 1)) - low);
}

Vec3 uniform_direction(Pcg32& random) {
  const double z = random.uniform(), phi = kTwoPi * random.uniform(), s = std::sqrt(1 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

TEST(Texture, TheLastLevelIsTheMeanOverTheHemisphere) {
  const Warp warps[] = {{}, {WarpKind::rational, 0.3}, {WarpKind::power, 0.5}};
  for (const Warp& warp : warps)
    for (const Table& table :
         {table_of(TableShape::line, 24, 1, warp, smooth), table_of(TableShape::disk, 21, 21, warp, smooth),
          table_of(TableShape::grid, 16, 9, warp, smooth)}) {
      Pcg32 random(5);
      double mean = 0;
      constexpr int kDraws = 200'000;
      for (int i = 0; i < kDraws; ++i)
        mean += lookup(table, uniform_direction(random), uniform_direction(random)) / kDraws;
      const Texture texture = make_texture(table, true);
      ASSERT_EQ(texture.levels.back().size(), 3u);
      EXPECT_NEAR(texture.levels.back()[0], mean, 4e-3);  // draws: 3 sigma = 1.5e-3; footprints: 16 points
      EXPECT_NEAR(texture.levels.back()[2], mean / 3, 2e-3);
    }
}

// The layers of a volume that are all one grid.
TEST(Texture, LevelsOfAVolumeAreThoseOfItsLayers) {
  const Warp warp{WarpKind::rational, 0.3};
  const Texture flat = make_texture(table_of(TableShape::grid, 9, 6, warp, smooth), true),
                deep = make_texture(table_of(TableShape::volume, 9, 6, warp, smooth, 4), true);
  EXPECT_EQ(flat.depth, 0);
  EXPECT_EQ(deep.depth, 4);
  ASSERT_EQ(deep.levels.size(), flat.levels.size());
  for (std::size_t l = 0; l < flat.levels.size(); ++l) {
    const std::size_t layer = flat.levels[l].size(), layers = std::max<std::size_t>(4 >> l, 1);
    ASSERT_EQ(deep.levels[l].size(), layers * layer);
    for (std::size_t i = 0; i < deep.levels[l].size(); ++i)
      EXPECT_NEAR(deep.levels[l][i], flat.levels[l][i % layer], 1e-6) << "level " << l << " texel " << i;
  }
}

TEST(Texture, LevelsHalveDownToOneTexel) {
  const Texture texture = make_texture(table_of(TableShape::grid, 13, 6, {}, smooth), true);
  ASSERT_EQ(texture.levels.size(), 4u);
  const std::size_t texels[] = {13 * 6, 6 * 3, 3 * 1, 1};
  for (std::size_t l = 0; l < 4; ++l) EXPECT_EQ(texture.levels[l].size(), 3 * texels[l]);
  EXPECT_EQ(make_texture(table_of(TableShape::grid, 13, 6, {}, smooth), false).levels.size(), 1u);
}

TEST(Texture, WhatNoDirectionReadsHasNoWeight) {
  const Table clean = table_of(TableShape::disk, 33, 33, {}, smooth);
  Table dirty = clean;
  for (int y = 0; y < 33; ++y)
    for (int x = 0; x < 33; ++x)
      if (std::hypot(x - 16, y - 16) > 16 + 1.5)  // more than a cell outside the horizon
        for (std::size_t c = 0; c < 3; ++c) dirty.values[static_cast<std::size_t>(3 * (33 * y + x)) + c] = 1;
  const Texture expected = make_texture(clean, true), found = make_texture(dirty, true);
  // the corner texels of the second level lie outside, those of the last three do not
  for (std::size_t level = 3; level < expected.levels.size(); ++level)
    for (std::size_t i = 0; i < expected.levels[level].size(); ++i)
      EXPECT_NEAR(found.levels[level][i], expected.levels[level][i], 1e-6) << level;
  EXPECT_NE(found.levels[1], expected.levels[1]);
}

TEST(Texture, ParabolicBordersAreReadWithoutLeavingTheMap) {
  const Table table = table_of(TableShape::disk, 17, 17, {}, smooth);
  for (int i = 0; i < 720; ++i) {
    const double phi = kTwoPi * i / 720, x = 8 + 8 * std::cos(phi), y = 8 + 8 * std::sin(phi);
    const Lookup at = locate(table.layout, kUse, {0, 0, 1}, {std::cos(phi), std::sin(phi), 0});
    ASSERT_LE(at.node % 17, 15);
    ASSERT_LE(at.node / 17, 15);
    EXPECT_NEAR(at.node % 17 + at.fx, x, 1e-9);
    EXPECT_NEAR(at.node / 17 + at.fy, y, 1e-9);
  }
}

TEST(CubeMap, HasTheTablesValueInEveryDirection) {
  for (const Table& table : {table_of(TableShape::disk, 33, 33, {WarpKind::rational, 0.5}, smooth),
                             table_of(TableShape::line, 32, 1, {}, smooth)}) {
    constexpr int kSide = 16;
    const Texture cube = make_cube_map(table, kSide, false);
    ASSERT_EQ(cube.levels[0].size(), 6u * 3 * kSide * kSide);
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          Vec3 w = cube_direction(face, (2 * x + 1.0) / kSide - 1, (2 * y + 1.0) / kSide - 1);
          if (w.z < 0) w = normalize({w.x, w.y, 0});
          const auto at = static_cast<std::size_t>(3 * ((face * kSide + y) * kSide + x));
          EXPECT_NEAR(cube.levels[0][at], lookup(table, w, {0, 0, 1}), 1e-6) << face;
        }
  }
}

TEST(CubeMap, FacesMeetAtTheirEdges) {
  // the largest component names the face: + and - of each axis, and edges are shared by two faces
  for (int face = 0; face < 6; ++face) {
    const Vec3 w = cube_direction(face, 0.3, -0.2);
    const double axis[] = {w.x, w.y, w.z};
    const double largest = axis[face / 2] * (face % 2 ? -1 : 1);
    for (const double a : axis) EXPECT_LE(std::abs(a), largest);
  }
  for (int i = 0; i <= 8; ++i) {
    const double t = i / 4.0 - 1;
    EXPECT_NEAR(length(cube_direction(4, 1, t) - cube_direction(0, -1, t)), 0, 1e-12);
    EXPECT_NEAR(length(cube_direction(4, -1, t) - cube_direction(1, 1, t)), 0, 1e-12);
    EXPECT_NEAR(length(cube_direction(4, t, -1) - cube_direction(2, t, 1)), 0, 1e-12);
    EXPECT_NEAR(length(cube_direction(5, -1, t) - cube_direction(0, 1, t)), 0, 1e-12);
  }
}

TEST(CubeMap, TheFaceOfTheNormalIsAveragedInSolidAngle) {
  const Table table = table_of(TableShape::disk, 33, 33, {}, smooth);
  Pcg32 random(8);
  double sum = 0, count = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Vec3 w = uniform_direction(random);
    if (std::max(std::abs(w.x), std::abs(w.y)) > w.z) continue;
    sum += lookup(table, w, {0, 0, 1});
    ++count;
  }
  const Texture cube = make_cube_map(table, 16, true);
  ASSERT_EQ(cube.levels.size(), 5u);
  ASSERT_EQ(cube.levels.back().size(), 18u);
  EXPECT_NEAR(cube.levels.back()[12], sum / count, 3e-3);
}

TEST(CubeMap, RefusesWhatHasNoDirection) {
  EXPECT_THROW(make_cube_map(table_of(TableShape::grid, 8, 8, {}, smooth), 8, false), Error);
  EXPECT_THROW(make_cube_map(table_of(TableShape::line, 8, 1, {}, smooth), 1, false), Error);
}

}  // namespace
}  // namespace burnish
