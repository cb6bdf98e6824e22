// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::kHalfRgb;

TEST(FitPlan, MoreBytesMeanSmallerErrors) {
  const AnalyticBrdf ward = parse_analytic("ggx:alpha_x=0.15,alpha_y=0.15,kd=0.3,f0=0.5");
  const TrainingSet set = draw_training_set(ward.ref(), {.pictures = 3000, .directions = 5000});
  double last_psnr = 0, last_relative = 1;
  for (const std::size_t bytes : {400u, 1200u, 3600u}) {
    const LobesFit fit =
        fit_plan(set, default_plan(bytes, 0, true, kHalfRgb), bytes, kHalfRgb, {.max_iterations = 12});
    const ErrorFigures e =
        error_figures(ward.ref(), to_brdf(fit.model, TableFormat::half), {.count = 5000, .image_size = 64});
    // Beyond 50 dB and 1 % the result of few steps depends on chance.
    EXPECT_GT(e.psnr, std::min(last_psnr, 50.0));
    EXPECT_LT(e.relative, std::max(last_relative, 0.01));
    last_psnr = e.psnr;
    last_relative = e.relative;
  }
  EXPECT_GT(last_psnr, 35);
}

TEST(FitPlan, SparesTexelsForGridsWhereThereAreMany) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.15,alpha_y=0.15,kd=0.3,f0=0.5");
  const TrainingSet set = draw_training_set(ggx.ref(), {.pictures = 1500, .directions = 3000});
  const LobesFit fit =
      fit_plan(set, default_plan(10'000, 1, true, kHalfRgb), 10'000, kHalfRgb, {.max_iterations = 4});
  const FactoredBrdf brdf = to_brdf(fit.model, TableFormat::half);
  EXPECT_LE(brdf.bytes(), 10'000u);
  EXPECT_TRUE(brdf.reciprocal());
  EXPECT_EQ(std::ranges::count(fit.model.spec.tables, TableShape::grid,
                               [](const auto& t) { return t.layout.shape; }),
            1);
  EXPECT_LT(fit.summary.error_after, fit.summary.error_before);
}

TEST(FitPlan, HoldsDiffuseAndAnisotropicGlossTogether) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.5,kd=0.3,f0=0.8");
  const TrainingSet set = draw_training_set(ggx.ref(), {.pictures = 3000, .directions = 12'000});
  const std::size_t bytes = 6000;
  const LobesFit fit =
      fit_plan(set, default_plan(bytes, 0, false, kHalfRgb), bytes, kHalfRgb, {.max_iterations = 10});
  const ErrorFigures e =
      error_figures(ggx.ref(), to_brdf(fit.model, TableFormat::half), {.count = 5000, .image_size = 64});
  EXPECT_LT(e.relative, 0.05);
  EXPECT_GT(e.psnr, 35);
}

}  // namespace
}  // namespace burnish
