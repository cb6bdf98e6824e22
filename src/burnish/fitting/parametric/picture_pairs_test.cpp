// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <burnish/fitting/parametric/picture_pairs.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>

namespace burnish {
namespace {

TEST(PicturePairs, ScoreAsThePicturesDo) {
  const struct {
    const char *source, *other;
  } kCases[] = {
      {"ggx:alpha_x=0.2,alpha_y=0.2,kd=0.1/0.2/0.3", "ggx:alpha_x=0.15,alpha_y=0.15,kd=0.2"},
      {"ggx:alpha_x=0.02,alpha_y=0.02", "ggx:alpha_x=0.05,alpha_y=0.05"},
      {"ggx:alpha_x=0.1,alpha_y=0.4,kd=0.1", "ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2"},
      {"oren_nayar:sigma=0.3", "lambert"},
  };
  for (const auto& [source, other] : kCases) {
    const AnalyticBrdf brdf = parse_analytic(source), model = parse_analytic(other);
    const Scorer scorer(brdf.ref(), {.count = 100});
    const PicturePairs pairs = picture_pairs(brdf.ref(), scorer.exposure());
    const double psnr = -10 * std::log10(pairs.mean_squared_error(pairs.shown_of(model.ref())));
    EXPECT_NEAR(psnr, scorer.picture_psnr(scorer.pictures(model.ref())), 0.3) << source;
  }
}

TEST(PicturePairs, CoverWhatIsLitOfTheSpheres) {
  // of the disks' area, lit at 30 and 60 degrees are 1/2 + cos / 2
  const double lit = (1 + (1 + std::cos(kPi / 6)) / 2 + (1 + std::cos(kPi / 3)) / 2) / 3 * kPi / 4;
  for (const char* spec : {"lambert", "ggx:alpha_x=0.1,alpha_y=0.2"}) {
    const AnalyticBrdf brdf = parse_analytic(spec);
    const PicturePairs pairs = picture_pairs(brdf.ref(), 1);
    EXPECT_NEAR(std::accumulate(pairs.weights.begin(), pairs.weights.end(), 0.0), lit, 0.01) << spec;
    EXPECT_EQ(pairs.shown.size(), 3 * pairs.pairs.size());
  }
}

}  // namespace
}  // namespace burnish
