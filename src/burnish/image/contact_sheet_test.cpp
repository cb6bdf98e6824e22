// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/image/contact_sheet.h>

namespace burnish {
namespace {

double luminance(Color c) {
  return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

Image8 filled(int width, int height, Color color) {
  Image8 image(width, height, 3);
  fill_rect(image, 0, 0, width, height, color);
  return image;
}

TEST(HeatColor, GetsLighterAllTheWayAndClamps) {
  for (int i = 1; i <= 100; ++i)
    EXPECT_GT(luminance(heat_color(i / 100.0)), luminance(heat_color((i - 1) / 100.0)) - 0.01) << i;
  EXPECT_LT(luminance(heat_color(0)), 8);
  EXPECT_GT(luminance(heat_color(1)), 235);
  EXPECT_EQ(heat_color(-1), heat_color(0));
  EXPECT_EQ(heat_color(7), heat_color(1));
  EXPECT_EQ(heat_color(std::nan("")), heat_color(0));
}

TEST(HeatMap, ShowsTheMeanDifferenceOnItsScale) {
  Image a(2, 1, 3), b(2, 1, 3);
  a.pixels = {0.5f, 0.5f, 0.5f, 1, 0, 0};
  b.pixels = {0.5f, 0.5f, 0.5f, 0, 0.5f, 0};
  const Image difference = mean_difference(a, b);
  EXPECT_EQ(difference.pixels, (std::vector<float>{0, 0.5f}));
  const Image8 map = heat_map(difference, 1);
  const Color expected = heat_color(0.5);
  EXPECT_EQ(map.at(1, 0)[0], expected.r);
  EXPECT_EQ(map.at(1, 0)[1], expected.g);
  EXPECT_EQ(map.at(1, 0)[2], expected.b);
  EXPECT_THROW(mean_difference(a, Image(2, 2, 3)), Error);
  EXPECT_THROW(heat_map(difference, 0), Error);
  EXPECT_THROW(heat_map(a, 1), Error);
}

TEST(ContactSheet, ShowsEveryCellWholeAndApart) {
  const Color red{250, 0, 0}, green{0, 250, 0}, blue{0, 0, 250};
  ContactSheet sheet{
      .title = "a title",
      .column_labels = {"one", "two\nlines"},
      .row_labels = {"first", "second"},
      .cells = {{filled(40, 30, red), filled(40, 30, green)}, {Image8{}, filled(40, 30, blue)}},
      .color_bar = ColorBar{0.5, "error"}};
  const Image8 image = compose(sheet);
  for (const Color color : {red, green, blue}) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const auto p = image.at(x, y);
        count += p[0] == color.r && p[1] == color.g && p[2] == color.b;
      }
    EXPECT_EQ(count, 40 * 30);
  }
}

TEST(ContactSheet, RefusesRaggedRows) {
  ContactSheet sheet{.title = "", .column_labels = {"one"}, .row_labels = {"first"}, .cells = {{}}};
  EXPECT_THROW(compose(sheet), Error);
  sheet.cells.clear();
  EXPECT_THROW(compose(sheet), Error);
}

}  // namespace
}  // namespace burnish
