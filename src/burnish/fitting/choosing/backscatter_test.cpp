// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/fitting/choosing/fetch_plan.h>
#include <burnish/fitting/choosing/frontal_pixels.h>
#include <burnish/fitting/choosing/volume_forms.h>
#include <burnish/fitting/refinement/refine.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

/// A factor of ten at wi = wo, and half of that 3.3 degrees from there.
struct RetroFactor {
  static constexpr double kSlope = 9;
  static double of(double slope, std::size_t, Vec3 wi, Vec3 wo) noexcept {
    const double share = angle_between(wi, wo) / radians(4);
    return 1 + slope * std::exp(-share * share);
  }
};
using Tape = fixtures::GlossyTimes<RetroFactor>;

/// Returns the largest relative error of a model at wi = wo and at one degree from there, 15 to 60 degrees off the
/// normal.
double error_of_peak(const Tape& tape, const FactoredBrdf& model) {
  double largest = 0;
  for (const double theta_deg : {15.0, 30.0, 60.0})
    for (const double off_deg : {0.0, 1.0}) {
      const Vec3 wi = spherical_direction(radians(theta_deg), 0.7),
                 wo = spherical_direction(radians(theta_deg + off_deg), 0.7);
      std::array<double, 3> truth, found;
      tape.eval(wi, wo, truth);
      model.eval(wi, wo, found);
      for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(found[c] / truth[c] - 1));
    }
  return largest;
}

TEST(Backscatter, IsSeenWhereALobeStandsAtThetaD0) {
  EXPECT_TRUE(backscatters(Tape{}));
  EXPECT_FALSE(backscatters(Tape{.slope = 0.3}));
  EXPECT_FALSE(backscatters(Tape{.even = {.blind_below = 1}}));  // no direction is known
  for (const char* spec : {"ggx:alpha_x=0.1", "ggx:alpha_x=0.5,alpha_y=0.2", "lambert", "openpbr"})
    EXPECT_FALSE(backscatters(parse_analytic(spec).ref())) << spec;
}

TEST(Backscatter, APeakIsHeldToFivePercentInTwoFetches) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Tape tape;
  const CostLimit limit{.bytes = 16'384, .fetches = 2};
  const TrainingSet set = with_frontal_pixels(
      tape, draw_training_set(tape, {.pictures = 8'000, .directions = 20'000, .crowded = true}), 0.1);
  const FactoredBrdf model =
      to_brdf(fit_volumes(set, volume_specs(tape, limit), {.smooth = 1e-8}).model, TableFormat::half);
  EXPECT_LT(error_of_peak(tape, model), 0.05);
}

}  // namespace
}  // namespace burnish
