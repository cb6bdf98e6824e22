// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/image/drawing.h>

namespace burnish {
namespace {

TEST(Drawing, StrokesCoverTheirArea) {
  Image8 image(100, 60, 3);
  const std::vector<std::vector<Point>> strokes = {{{10, 20}, {80, 50}}};
  draw_strokes(image, strokes, 6, {255, 255, 255});
  double covered = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) covered += image.pixels[i] / 255.0;
  EXPECT_NEAR(covered, std::hypot(70, 30) * 6 + 9 * 3.14159, 5);
}

TEST(Drawing, DashesKeepTheirRhythmAroundCorners) {
  const std::vector<Point> corner = {{0, 0}, {10, 0}, {10, 10}};
  const auto pieces = dashes(corner, 4, 3);
  ASSERT_EQ(pieces.size(), 3u);  // 0-4, 7-11 around the corner, 14-18
  EXPECT_EQ(pieces[1].size(), 3u);
  EXPECT_EQ(pieces[1].back(), (Point{10, 1}));
  EXPECT_EQ(pieces[2].front(), (Point{10, 4}));
}

TEST(Drawing, TextStaysWithinItsWidthAndOutsideTheImageHarmsNothing) {
  Image8 image(200, 40, 3);
  const std::string text = "Hg 0°θ\xff ж";
  draw_text(image, {20, 25}, text, 12, {255, 255, 255});
  const double width = text_width(text, 12);
  int inside = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 200; ++x)
      if (image.at(x, y)[0] > 0) {
        EXPECT_GE(x, 18);
        EXPECT_LE(x, 22 + width);
        ++inside;
      }
  EXPECT_GT(inside, 100);
  draw_text(image, {-500, 1000}, text, 12, {255, 255, 255}, Align::right, true);
}

TEST(Drawing, BlitBlendsByAlphaAndCutsAtTheEdges) {
  Image8 to(4, 4, 3), from(3, 3, 4);
  for (std::size_t i = 0; i < from.pixels.size(); i += 4) {
    from.pixels[i] = 200;
    from.pixels[i + 3] = 128;
  }
  blit(to, from, 2, -1);
  EXPECT_EQ(to.at(3, 1)[0], 100);
  EXPECT_EQ(to.at(3, 2)[0], 0);
  EXPECT_EQ(to.at(1, 0)[0], 0);
}

}  // namespace
}  // namespace burnish
