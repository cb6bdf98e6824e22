// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/choosing/fetch_plan.h>
#include <burnish/fitting/choosing/volume_forms.h>
#include <burnish/fitting/choosing/volume_smoothness.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

const AnalyticBrdf kGgx = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.1,kd=0.2");

ModelSpec small_volume() {
  return volume_specs(kGgx.ref(), {.bytes = 1'600, .fetches = 1}).front();
}

TEST(VolumeSmoothness, TakesNoiseAway) {
  const Samples samples = measure(kGgx.ref(), {.count = 3000, .noise = 0.5});
  const double chosen = choose_volume_smoothness(measured_nodes(samples), small_volume(), true);
  EXPECT_EQ(choose_volume_smoothness(measured_nodes(samples), small_volume(), true), chosen);

  // The error is that against the truth, without the measurement's noise.
  const TrainingSet set = training_set_of(samples, true);
  const auto error = [&](double smooth) {
    const LobesFit fit =
        fit_volumes(set, {small_volume()}, {.shares = {.relative = 2, .log_cos = 2}, .smooth = smooth});
    return error_figures(kGgx.ref(), to_brdf(fit.model, TableFormat::half), {.count = 5000, .image_size = 32})
        .relative;
  };
  EXPECT_LT(error(chosen), 0.8 * error(1e-9));
}

TEST(VolumeSmoothness, NeedsNodesInBothHalves) {
  const MeasuredNodes nodes = measured_nodes(measure(kGgx.ref(), {.count = 500}));
  const MeasuredNodes one = nodes_of(nodes, {.kind = NodePart::Kind::half, .number = 0});
  EXPECT_THROW(choose_volume_smoothness(one, small_volume(), true), Error);
}

}  // namespace
}  // namespace burnish
