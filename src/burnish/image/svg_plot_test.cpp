// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <burnish/error.h>
#include <burnish/image/drawing.h>
#include <burnish/image/svg_plot.h>

namespace burnish {
namespace {

auto NearTo(const std::vector<double>& values) {
  return ::testing::Pointwise(::testing::DoubleNear(1e-12), values);
}

Plot small_plot() {
  Plot plot{
      .title = "a < b & c", .x_label = "θ (degrees)", .y_label = "f (1/sr)", .width = 320, .height = 240};
  plot.series = {{.label = "first", .x = {0, 1, 2}, .y = {1, 10, 100}},
                 {.label = "", .x = {0.5}, .y = {60}, .style = PlotStyle::points, .color = "#ff0000"}};
  return plot;
}

// Returns the number of pixels that have about this colour.
int count_pixels(const Image8& image, Color color) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto p = image.at(x, y);
      count += std::abs(p[0] - color.r) + std::abs(p[1] - color.g) + std::abs(p[2] - color.b) < 20;
    }
  return count;
}

TEST(AxisTicks, AreRoundAndInside) {
  EXPECT_THAT(axis_ticks(0, 1, false, 5), NearTo({0, 0.2, 0.4, 0.6, 0.8, 1}));
  EXPECT_THAT(axis_ticks(-90, 90, false, 7), NearTo({-80, -60, -40, -20, 0, 20, 40, 60, 80}));
  EXPECT_THAT(axis_ticks(0.01, 10, true), NearTo({0.01, 0.1, 1, 10}));
  EXPECT_THAT(axis_ticks(1, 10, true), NearTo({1, 2, 5, 10}));
  EXPECT_THAT(axis_ticks(3, 4, true, 4), NearTo({3, 3.2, 3.4, 3.6, 3.8, 4}));
  EXPECT_LT(axis_ticks(1e-30, 1e30, true).size(), 12u);
}

TEST(SvgPlot, IsWellFormedAndKeepsItsLabels) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(to_svg(small_plot()).c_str()));
  std::vector<std::string> texts;
  for (const auto& text : document.child("svg").children("text")) texts.push_back(text.text().get());
  for (const char* label : {"a < b & c", "θ (degrees)", "f (1/sr)", "first"})
    EXPECT_THAT(texts, ::testing::Contains(label));
}

TEST(SvgPlot, InterruptsALineWhereAValueCannotBeShown) {
  Plot plot = small_plot();
  plot.log_y = true;
  plot.series = {{.label = "", .x = {0, 1, 2, 3, 4}, .y = {1, 2, 0, std::nan(""), 4}, .color = "#00ff00"}};
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(to_svg(plot).c_str()));
  const std::string path =
      document.child("svg").find_child_by_attribute("path", "stroke", "#00ff00").attribute("d").value();
  EXPECT_EQ(std::ranges::count(path, 'M'), 2);
  EXPECT_EQ(std::ranges::count(path, 'L'), 1);
}

TEST(SvgPlot, DrawsTheSameCurvesAsPixels) {
  const Image8 image = to_image(small_plot());
  EXPECT_EQ(image.width, 320);
  EXPECT_EQ(image.height, 240);
  EXPECT_NEAR(count_pixels(image, {255, 0, 0}), 16, 8);  // the dot is 4.5 pixels wide
  EXPECT_GT(count_pixels(image, {0x1b, 0x6c, 0xa8}), 100);
}

TEST(SvgPlot, CutsCurvesAtTheFrame) {
  Plot plot = small_plot();
  plot.series = {{.label = "", .x = {0, 1}, .y = {0.5, 0.5}, .color = "#ff0000"}};
  plot.y_min = 0;
  plot.y_max = 1;
  EXPECT_GT(count_pixels(to_image(plot), {255, 0, 0}), 150);
  plot.series[0].y = {7, 7};
  EXPECT_EQ(count_pixels(to_image(plot), {255, 0, 0}), 0);
}

TEST(SvgPlot, DrawsWithoutDataAndWithAConstant) {
  Plot plot = small_plot();
  plot.series[0].y = {3, 3, 3};
  plot.series.pop_back();
  EXPECT_GT(count_pixels(to_image(plot), {0x1b, 0x6c, 0xa8}), 100);
  plot.series.clear();
  plot.log_x = plot.log_y = true;
  EXPECT_EQ(to_image(plot).width, 320);
}

TEST(SvgPlot, RefusesBadInput) {
  Plot plot = small_plot();
  plot.series[0].x.pop_back();
  EXPECT_THROW(to_svg(plot), Error);
  plot = small_plot();
  plot.series[0].color = "red";
  EXPECT_THROW(to_image(plot), Error);
  plot = small_plot();
  plot.x_min = 4;
  EXPECT_THROW(to_svg(plot), Error);
  plot = small_plot();
  plot.log_y = true;
  plot.y_min = -1;
  EXPECT_THROW(to_svg(plot), Error);
  plot = small_plot();
  plot.width = 0;
  EXPECT_THROW(to_svg(plot), Error);
}

}  // namespace
}  // namespace burnish
