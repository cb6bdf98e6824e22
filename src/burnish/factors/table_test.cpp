// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/table.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

TEST(TableShape, NamesReadBack) {
  for (const TableShape shape : {TableShape::line, TableShape::disk, TableShape::grid, TableShape::volume})
    EXPECT_EQ(parse_table_shape(to_string(shape)), shape);
  EXPECT_THROW(parse_table_shape("Line"), Error);
  EXPECT_THROW(parse_table_shape(""), Error);
}

constexpr std::array<Warp, 3> kTableWarps{{{}, {WarpKind::power, 0.5}, {WarpKind::rational, 0.2}}};

TEST(Table, NodesAreFoundWhereTheyStand) {
  const Vec3 any{0.6, 0, 0.8};
  for (const Warp& warp : kTableWarps) {
    const TableLayout line{.width = 9, .warp = warp, .warp_y = {}, .warp_z = {}},
        disk{.shape = TableShape::disk, .width = 9, .height = 9, .warp = warp, .warp_y = {}, .warp_z = {}};
    EXPECT_NEAR(node_direction(line, 0, 0).z, 1, 1e-15);
    EXPECT_NEAR(node_direction(line, 8, 0).z, 0, 1e-15);
    for (const TableLayout& layout : {line, disk})
      for (const auto& [use, exchanged] : {std::pair(kProjectWi, false), std::pair(kProjectWo, true)})
        for (int y = 0; y < layout.height; ++y)
          for (int x = 0; x < layout.width; ++x) {
            // the corners of a disk stand for its rim
            if (layout.shape == TableShape::disk && (x - 4) * (x - 4) + (y - 4) * (y - 4) > 16) continue;
            const Vec3 w = node_direction(layout, x, y);
            const FactorUse factor{.table = 0, .projection = use, .projection_y = {}, .projection_z = {}};
            const Lookup found = exchanged ? locate(layout, factor, any, w) : locate(layout, factor, w, any);
            // a root at the normal makes 1e-16 1e-8
            EXPECT_NEAR(found.node % 9 + found.fx, x, 1e-6) << to_string(warp);
            EXPECT_NEAR(found.node / 9 + found.fy, y, 1e-6) << to_string(warp);
          }
  }
}

// A grid's and a volume's axes are each along their own angle.
TEST(Table, AxesFollowTheirProjections) {
  const FactorUse use{
      .table = 0, .projection = kProjectHalf, .projection_y = kProjectDifference, .projection_z = kProjectWi};
  const TableLayout grid{.shape = TableShape::grid,
                         .width = 7,
                         .height = 5,
                         .warp = kTableWarps[1],
                         .warp_y = kTableWarps[2],
                         .warp_z = {}},
      volume{.shape = TableShape::volume,
             .width = 7,
             .height = 5,
             .depth = 4,
             .warp = kTableWarps[2],
             .warp_y = {},
             .warp_z = kTableWarps[1]};
  for (const auto& [wi, wo] : corner_and_random_pairs(1000)) {
    if (wi.z <= 0 || wo.z <= 0) continue;
    for (const TableLayout& layout : {grid, volume}) {
      const Lookup found = locate(layout, use, wi, wo);
      const int x = found.node % 7, y = found.node / 7 % 5, z = found.node / 35;
      const auto along = [&, wi = wi, wo = wo](const Warp& warp, const Projection& projection, int nodes) {
        return warp.forward(project_tan_half(projection, wi, wo)) * (nodes - 1);
      };
      EXPECT_NEAR(x + found.fx, along(layout.warp, use.projection, 7), 1e-12);
      EXPECT_NEAR(y + found.fy, along(layout.warp_y, use.projection_y, 5), 1e-12);
      EXPECT_NEAR(z + found.fz, layout.depth > 1 ? along(layout.warp_z, use.projection_z, 4) : 0, 1e-12);
      // and the nodes above are there
      EXPECT_LT(x + (found.fx > 0), 7);
      EXPECT_LT(y + (found.fy > 0), 5);
      EXPECT_LT(z + (found.fz > 0), layout.depth);
      for (const double fraction : {found.fx, found.fy, found.fz}) {
        EXPECT_GE(fraction, 0);
        EXPECT_LE(fraction, 1);
      }
    }
  }
}

TEST(Table, RefusesSizesThatDoNotFitTheShape) {
  const auto fits = [](TableShape shape, int width, int height = 1, int depth = 1) {
    try {
      check_layout({.shape = shape,
                    .width = width,
                    .height = height,
                    .depth = depth,
                    .warp = {},
                    .warp_y = {},
                    .warp_z = {}},
                   "q");
    } catch (const Error&) {
      return false;
    }
    return true;
  };
  using enum TableShape;
  EXPECT_TRUE(fits(line, 2) && fits(line, kMaxSide));
  EXPECT_FALSE(fits(line, 1) || fits(line, kMaxSide + 1) || fits(line, 4, 2) || fits(line, 4, 1, 2));
  EXPECT_TRUE(fits(disk, 5, 5));
  EXPECT_FALSE(fits(disk, 5, 4) || fits(disk, 1, 1) || fits(disk, 5, 5, 5));
  EXPECT_TRUE(fits(grid, 2, kMaxSide));
  EXPECT_FALSE(fits(grid, 2, 1) || fits(grid, 2, kMaxSide + 1) || fits(grid, 2, 2, 2));
  EXPECT_TRUE(fits(volume, 2, 2, 2) && fits(volume, kMaxVolumeSide, 32, kMaxVolumeSide));
  EXPECT_FALSE(fits(volume, 2, 2) || fits(volume, 2, 1, 2) || fits(volume, 2, 33, kMaxVolumeSide) ||
               fits(volume, kMaxVolumeSide + 1, 2, 2));
}

}  // namespace
}  // namespace burnish
