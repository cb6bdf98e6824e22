// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/refinement/rounding.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::random_model;
using fixtures::small_set;

TEST(ToRoundedBrdf, LosesLessThanRoundingEachValue) {
  const AnalyticBrdf paint = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2,kd=0.4/0.02/0.1,f0=0.05/0.5/0.9");
  const TrainingSet set = small_set(paint);
  for (const char* p : {"p=9", "p=9,shared"})
    for (const TableFormat format : {TableFormat::rgb9e5, TableFormat::unorm8}) {
      const RefineOptions options{.format = format, .max_iterations = 12};
      const LobesFit fit = fit_lobes(
          set, parse_model_spec("p(wo) p(wi) q(h) r(theta_d)", std::vector<std::string>{p, "q=40"}, true),
          options);
      // what refinement lowers, of what is stored, on directions that were not fitted
      const auto error = [&](const FactoredBrdf& brdf) {
        const ErrorFigures e = error_figures(paint.ref(), brdf, {.count = 20'000, .image_size = 64});
        const ErrorTerms shares = options.shares;
        return shares.pictures * std::log(std::pow(10, -e.psnr / 10)) +
               shares.relative * std::log(e.relative) + shares.log_cos * std::log(e.log_cos);
      };
      const FactoredBrdf compensated = to_rounded_brdf(fit.model, set, options),
                         nearest = to_brdf(fit.model, format);
      EXPECT_EQ(compensated.bytes(), nearest.bytes());
      EXPECT_TRUE(compensated.reciprocal());
      EXPECT_LT(error(compensated), error(nearest) + 0.01) << to_string(format) << p;
      if (format == TableFormat::unorm8 && std::string(p) == "p=9,shared") {
        EXPECT_LT(error(compensated), error(nearest) - 0.2);
      }
    }
  const LogModel model = random_model("p(wo) p(wi) q(h)", {}, 3);
  EXPECT_EQ(to_rounded_brdf(model, set, {.format = TableFormat::half}), to_brdf(model, TableFormat::half));
}

}  // namespace
}  // namespace burnish
