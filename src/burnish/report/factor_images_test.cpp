// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/report/factor_images.h>

namespace burnish {
namespace {

TEST(FactorImage, ShowsEveryDoublingAsTheSameStep) {
  const Table table{.name = "p", .layout = {.width = 3}, .channels = 1, .values = {1, 0x1p-7f, 0x1p-14f}};
  const Image8 image = factor_image(table);
  EXPECT_EQ(image.at(0, 0)[0], 255);
  EXPECT_EQ(image.at(image.width / 2, 5)[1], 128);
  EXPECT_EQ(image.at(image.width - 1, 5)[2], 0);
}

TEST(FactorImage, PutsTheFirstRowAtTheBottom) {
  const Table table{.name = "q",
                    .layout = {.shape = TableShape::disk, .width = 2, .height = 2},
                    .channels = 3,
                    .values = {1, 0x1p-14f, 1, 1, 1, 1, 0x1p-14f, 1, 1, 1, 1, 1}};
  const Image8 image = factor_image(table);
  EXPECT_EQ(image.at(0, image.height - 1)[0], 255);
  EXPECT_EQ(image.at(0, image.height - 1)[1], 0);
  EXPECT_EQ(image.at(0, 0)[0], 0);
}

}  // namespace
}  // namespace burnish
