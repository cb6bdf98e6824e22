#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/smoothed_nodes.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

constexpr NodeVolume kFewPlaces{24, 16, 6};

/// Mean |ln(f / f^)| over other pairs with both cosines above 0.15, of the first channel.
double mean_log_error(BrdfRef truth, BrdfRef guess) {
  std::vector<double> f(3), g(3);
  double sum = 0;
  int count = 0;
  for (const auto& [wi, wo] : draw_pairs(3000, 77, true)) {
    if (std::min(wi.z, wo.z) < 0.15) continue;
    truth.eval(wi, wo, f);
    guess.eval(wi, wo, g);
    sum += std::abs(std::log(f[0] / g[0]));
    ++count;
  }
  return sum / count;
}

TEST(SmoothedNodes, GoThroughSmoothSources) {
  const fixtures::Glossy source{.a = 8, .b = 8};
  const SmoothedNodes smooth(measured_nodes(measure(source, {.count = 4000, .noise = 0})));
  EXPECT_LT(mean_log_error(source, smooth), 0.01);
}

TEST(SmoothedNodes, TakeNoiseAway) {
  const fixtures::Glossy source{.a = 8, .b = 8};
  const SmoothedNodes smooth(measured_nodes(measure(source, {.count = 4000, .noise = 0.2})),
                             {{1e-6, 1e-5, 1e-4, 1e-6}}, kFewPlaces);
  EXPECT_LT(mean_log_error(source, smooth), 0.05);  // a quarter of the noise
}

/// GGX-like in theta_h, of which a goniometer that stands at a few incidences sees a surface of the volume each.
Samples of_few_incidences(BrdfRef source, int skipped) {
  Samples samples{.channels = 3, .isotropic = true};
  std::vector<double> f(3);
  for (int i = 0; i < 7; ++i)
    for (int o = 0; i != skipped && o < 400; ++o) {
      const DirectionPair pair{spherical_direction(radians(12 * i), 0),
                               spherical_direction(radians(4 * (o / 20) + 1), kTwoPi * (o % 20) / 20)};
      source.eval(pair.wi, pair.wo, f);
      samples.pairs.push_back(pair);
      samples.values.insert(samples.values.end(), f.begin(), f.end());
    }
  return samples;
}

TEST(SmoothedNodes, KnowWhatStandsBetweenIncidences) {
  const fixtures::Glossy source{.a = 8, .b = 8};
  const SmoothedNodes seven(measured_nodes(of_few_incidences(source, -1)), {}, kFewPlaces),
      six(measured_nodes(of_few_incidences(source, 3)), {}, kFewPlaces);
  EXPECT_LT(mean_log_error(source, six), 2 * mean_log_error(source, seven));
}

TEST(SmoothedNodes, AreReciprocalIsotropicAndTheirOwnMirrorImage) {
  const SmoothedNodes smooth(
      measured_nodes(measure(fixtures::Glossy{.a = 8, .b = 8}, {.count = 1000, .noise = 0.1})), {},
      kFewPlaces);
  std::vector<double> f(3), g(3);
  for (const auto& [wi, wo] : draw_pairs(200, 3, false)) {
    const HalfDiff a = to_half_diff(wi, wo);
    const auto mirrored =
        from_half_diff({.theta_h = a.theta_h, .phi_h = a.phi_h + 1, .theta_d = a.theta_d, .phi_d = -a.phi_d});
    smooth.eval(wi, wo, f);
    for (const auto& [a1, b1] : {std::pair(wo, wi), std::pair(mirrored.wi, mirrored.wo)}) {
      smooth.eval(a1, b1, g);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(g[c] / f[c], 1, 1e-9);
    }
  }
}

TEST(SmoothedNodes, ValuesLieBetweenZeroAndTwiceTheLargest) {
  Samples samples = measure(fixtures::Lambert{}, {.count = 300, .noise = 0});
  for (double& value : samples.values) value = -value;
  const SmoothedNodes dark(measured_nodes(samples), {}, kFewPlaces);
  std::vector<double> f(3, 1);
  for (const auto& [wi, wo] : draw_pairs(100, 3, true)) {
    EXPECT_TRUE(dark.eval(wi, wo, f));
    for (const double value : f) EXPECT_EQ(value, 0);
  }
  EXPECT_TRUE(dark.eval({0, 0, -1}, {0, 0, 1}, f));
}

TEST(SmoothedNodes, NeedIsotropicNodesAboveTheHorizon) {
  Samples samples = measure(fixtures::Lambert{}, {.count = 10, .noise = 0});
  samples.isotropic = false;
  EXPECT_THROW(SmoothedNodes(measured_nodes(samples)), Error);
  samples.isotropic = true;
  samples.pairs.assign(10, {spherical_direction(radians(89.9), 0), {0, 0, 1}});
  EXPECT_THROW(SmoothedNodes(measured_nodes(samples)), Error);
}

}  // namespace
}  // namespace burnish
