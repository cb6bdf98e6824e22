// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/metrics/figures_json.h>

namespace burnish {
namespace {

ErrorFigures some_figures() {
  return {.log_cos = 1,
          .relative = 2,
          .rms_log = 3,
          .rms = 4,
          .mean_abs_log = 5,
          .psnr = 6,
          .ssim = 7,
          .unknown_fraction = 8};
}

TEST(FiguresJson, KeepsTheOrderThatIsAskedFor) {
  EXPECT_EQ(json_of(some_figures()).dump(),
            R"({"psnr":6.0,"ssim":7.0,"relative":2.0,"rms_log":3.0,"log_cos":1.0})");
  EXPECT_EQ(json_of(some_figures(), {"unknown_fraction", "mean_abs_log", "rms"}).dump(),
            R"({"unknown_fraction":8.0,"mean_abs_log":5.0,"rms":4.0})");
  const NodeFigures nodes{.log_cos = 1, .relative = 2, .rms_log = 3, .rms = 4, .count = 5};
  EXPECT_EQ(json_of(nodes).dump(), R"({"count":5,"relative":2.0,"rms_log":3.0,"log_cos":1.0})");
  EXPECT_EQ(json_of(nodes, {"rms"}).dump(), R"({"count":5,"rms":4.0})");
}

TEST(FiguresJson, WritesNullWhereThereIsNoNumber) {
  ErrorFigures figures = some_figures();
  figures.psnr = std::numeric_limits<double>::infinity();
  figures.ssim = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(json_of(figures, {"psnr", "ssim"}).dump(), R"({"psnr":null,"ssim":null})");
}

TEST(FiguresJson, RefusesWhatIsNoFigure) {
  EXPECT_THROW(json_of(some_figures(), {"psnr", "PSNR"}), Error);
  EXPECT_THROW(json_of(NodeFigures{}, {"psnr"}), Error);
}

}  // namespace
}  // namespace burnish
