// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

/// With sanitizers the covariance is not looked for, which takes them minutes.
KrigedNodes kriged(const Samples& samples) {
  const MeasuredNodes nodes = measured_nodes(samples);
  return {nodes, BURNISH_SANITIZED ? LogCovariance(nodes.samples.isotropic) : choose_covariance(nodes)};
}

/// Mean |ln(f / f^)| over other pairs with both cosines above 0.15, of the first channel.
double mean_log_error(BrdfRef truth, BrdfRef guess) {
  std::vector<double> f(3), g(3);
  double sum = 0;
  int count = 0;
  for (const auto& [wi, wo] : draw_pairs(2000, 77, true)) {
    if (std::min(wi.z, wo.z) < 0.15) continue;
    truth.eval(wi, wo, f);
    guess.eval(wi, wo, g);
    sum += std::abs(std::log(f[0] / g[0]));
    ++count;
  }
  return sum / count;
}

TEST(KrigedNodes, GoThroughSmoothSources) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const fixtures::Glossy source{.a = 8, .b = 8};
  EXPECT_LT(mean_log_error(source, kriged(measure(source, {.count = 2000, .noise = 0}))), 0.01);
}

TEST(KrigedNodes, TakeNoiseAway) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const fixtures::Glossy source{.a = 8, .b = 8};
  // the mean error of a measurement itself is 0.2 sqrt(2 / pi) = 0.16
  EXPECT_LT(mean_log_error(source, kriged(measure(source, {.count = 2000, .noise = 0.2}))), 0.05);
}

TEST(KrigedNodes, PredictAnisotropicSources) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const fixtures::Glossy source{.a = 4, .b = 16};
  const Samples samples = measure(source, {.count = 2000, .noise = 0});
  ASSERT_FALSE(samples.isotropic);
  EXPECT_LT(mean_log_error(source, kriged(samples)), 0.03);
}

TEST(KrigedNodes, PriorCovariancesAreThoseOfLogCovariance) {
  // One node of next to no weight determines nothing.
  Samples samples{.channels = 1, .isotropic = true};
  samples.pairs.push_back({{0, 0, 1}, {0, 0, 1}});
  samples.values.push_back(0.2);
  MeasuredNodes nodes = measured_nodes(samples);
  nodes.weights[0] = 1e-12;
  const LogCovariance covariance(true);
  const KrigedNodes function(nodes, covariance, true);
  const auto pairs = draw_pairs(200, 5, true);
  const DirectionPair one{spherical_direction(1.53, 0), spherical_direction(0.7, 2)};
  std::vector<double> found(pairs.size());
  function.covariances_with(one, pairs, found);
  const TreePoint a = place_of(one.wi, one.wo, true);
  const double grazing = grazing_measure(one.wi, one.wo);
  ASSERT_GT(grazing, 1);
  int grazed = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const TreePoint b = place_of(pairs[i].wi, pairs[i].wo, true);
    const double other = grazing_measure(pairs[i].wi, pairs[i].wo);
    grazed += other > 0;
    const double expected = covariance.between(a, b) + covariance.grazing_between(a, grazing, b, other);
    EXPECT_NEAR(found[i], expected, 1e-5 * covariance.variance(grazing));
  }
  EXPECT_GT(grazed, 10);
}

/// Returns the mean of ln(f / prediction) where one cosine is 0.02. f = (cos theta_i cos theta_o)^-exponent is measured
/// at cosines from 0.06 on.
double rise_missed_at_horizon(double exponent, double grazing) {
  const auto rise = [exponent](Vec3 wi, Vec3 wo) { return 0.1 * std::pow(wi.z * wo.z, -exponent); };
  Samples samples{.channels = 1, .isotropic = true};
  Pcg32 random(5);
  while (samples.size() < 1500) {
    const DirectionPair pair{spherical_direction(std::acos(random.uniform()), 0),
                             spherical_direction(std::acos(random.uniform()), kTwoPi * random.uniform())};
    if (std::min(pair.wi.z, pair.wo.z) < 0.06) continue;
    samples.pairs.push_back(pair);
    samples.values.push_back(rise(pair.wi, pair.wo));
  }
  LogCovariance covariance(true);
  covariance.grazing = grazing;
  const KrigedNodes function(measured_nodes(samples), covariance);
  double sum = 0;
  constexpr int kPlaces = 12;
  for (int i = 0; i < kPlaces; ++i) {
    const Vec3 wi = spherical_direction(std::acos(0.02), 0),
               wo = spherical_direction(radians(30), kTwoPi * i / kPlaces);
    std::vector<double> f(1);
    function.eval(wi, wo, f);
    sum += std::log(rise(wi, wo) / f[0]) / kPlaces;
  }
  return sum;
}

TEST(KrigedNodes, GoOnRisingTowardsTheHorizonAsMeasured) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const double with = rise_missed_at_horizon(0.8, LogCovariance(true).grazing),
               without = rise_missed_at_horizon(0.8, 0);
  EXPECT_LT(std::abs(with), 0.4);
  EXPECT_GT(without, 2 * std::abs(with));
  // A source that does not rise stays level.
  EXPECT_NEAR(rise_missed_at_horizon(0, LogCovariance(true).grazing), 0, 0.02);
}

/// A goniometer that stands at a few incidences, one of which may be left out.
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

TEST(KrigedNodes, KnowWhatStandsBetweenIncidences) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const fixtures::Glossy source{.a = 8, .b = 8};
  const double seven = mean_log_error(source, kriged(of_few_incidences(source, -1))),
               six = mean_log_error(source, kriged(of_few_incidences(source, 3)));
  EXPECT_LT(seven, 0.05);
  EXPECT_LT(six, 2.5 * seven);
}

TEST(KrigedNodes, AreReciprocalIsotropicAndTheirOwnMirrorImage) {
  const KrigedNodes function =
      kriged(measure(fixtures::Glossy{.a = 8, .b = 8}, {.count = 500, .noise = 0.1}));
  std::vector<double> f(3), g(3);
  for (const auto& [wi, wo] : draw_pairs(200, 3, false)) {
    const HalfDiff a = to_half_diff(wi, wo);
    const auto mirrored =
        from_half_diff({.theta_h = a.theta_h, .phi_h = a.phi_h + 1, .theta_d = a.theta_d, .phi_d = -a.phi_d});
    function.eval(wi, wo, f);
    for (const auto& [a1, b1] : {std::pair(wo, wi), std::pair(mirrored.wi, mirrored.wo)}) {
      function.eval(a1, b1, g);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(g[c] / f[c], 1, 1e-3);
    }
  }
}

TEST(KrigedNodes, OfTheNearestNodeAgreeWithThoseOfThePairItself) {
  // Pairs share neighbours; a pair's own neighbours predict nearly the same.
  const Samples samples = measure(fixtures::Glossy{.a = 8, .b = 8}, {.count = 3000, .noise = 0.05});
  const KrigedNodes function = kriged(samples);
  std::vector<double> f(3), g(3);
  double sum = 0;
  const auto pairs = draw_pairs(500, 5, true);
  for (const auto& [wi, wo] : pairs) {
    function.eval(wi, wo, f);
    function.eval_from(
        wi, wo, [](std::size_t) { return true; }, g);
    sum += std::abs(std::log((f[0] + 1e-3) / (g[0] + 1e-3)));
  }
  EXPECT_LT(sum / static_cast<double>(pairs.size()), 0.02);
}

TEST(KrigedNodes, AreUncertainWhereNothingWasMeasured) {
  // all nodes under light from near the normal
  const fixtures::Glossy source{.a = 8, .b = 8};
  Samples samples{.channels = 3, .isotropic = true};
  std::vector<double> f(3);
  for (int i = 0; i < 4; ++i)
    for (int o = 0; o < 200; ++o) {
      const DirectionPair pair{spherical_direction(radians(5 * i), 0),
                               spherical_direction(radians(4 * (o / 10)), kTwoPi * (o % 10) / 10)};
      source.eval(pair.wi, pair.wo, f);
      samples.pairs.push_back(pair);
      samples.values.insert(samples.values.end(), f.begin(), f.end());
    }
  const KrigedNodes function = kriged(samples);
  const LogUncertainty seen = function.uncertainty(spherical_direction(radians(7), 0),
                                                   spherical_direction(0.5, 2)),
                       unseen = function.uncertainty(spherical_direction(radians(75), 0),
                                                     spherical_direction(radians(80), 3)),
                       below = function.uncertainty({0, 0, -1}, {0, 0, 1});
  EXPECT_GT(unseen.function, 3 * seen.function);
  EXPECT_GT(seen.reading, seen.function);
  EXPECT_EQ(below.function, 0);
  EXPECT_EQ(below.reading, 0);
}

/// The share of other readings of the source that lie within the middle 90 % of a normal distribution.
double share_within_90(BrdfRef source, std::size_t count, double noise) {
  const KrigedNodes function = kriged(measure(source, {.count = count, .noise = noise}));
  const Samples others = measure(source, {.count = 2000, .noise = noise, .seed = 99});
  std::vector<double> f(others.channels);
  std::size_t within = 0, all = 0;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const auto [wi, wo] = others.pairs[i];
    if (std::min(wi.z, wo.z) < 0.15) continue;
    function.eval(wi, wo, f);
    const double reach = 1.645 * function.uncertainty(wi, wo).reading;
    for (std::size_t c = 0; c < f.size(); ++c, ++all)
      within +=
          std::abs(std::log((others.at(i)[c] + KrigedNodes::kFloor) / (f[c] + KrigedNodes::kFloor))) < reach;
  }
  return static_cast<double>(within) / static_cast<double>(all);
}

TEST(KrigedNodes, KnowHowFarOffReadingsAre) {
  BURNISH_SKIP_WHERE_SANITIZED();
  for (const double noise : {0.05, 0.2})
    for (const std::size_t count : {300, 3000})
      for (const double a : {8.0, 200.0}) {
        const double share = share_within_90(fixtures::Glossy{.a = a, .b = a}, count, noise);
        EXPECT_GT(share, 0.85) << noise << " " << count << " " << a;
        EXPECT_LT(share, 0.95) << noise << " " << count << " " << a;
      }
}

// A source that is rough in one corner: its nodes say so there alone.
TEST(KrigedNodes, AreUncertainWhereNodesAreRough) {
  BURNISH_SKIP_WHERE_SANITIZED();
  Samples samples = measure(fixtures::Lambert{}, {.count = 3000, .noise = 0.02});
  Pcg32 random(4);
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (angle_between(samples.pairs[i].wi, samples.pairs[i].wo) > 2)
      for (double& value : samples.at(i)) value *= std::exp(0.6 * (2 * random.uniform() - 1));
  const KrigedNodes function = kriged(samples);
  const auto reading = [&](double theta) {
    return function.uncertainty(spherical_direction(theta, 0), spherical_direction(theta, kPi)).reading;
  };
  EXPECT_GT(reading(1.25), 3 * reading(0.3));
}

TEST(KrigedNodes, ValuesLieBetweenZeroAndTwiceTheLargest) {
  Samples samples = measure(fixtures::Lambert{}, {.count = 300, .noise = 0});
  for (double& value : samples.values) value = -value;
  const KrigedNodes dark = kriged(samples);
  std::vector<double> f(3, 1);
  for (const auto& [wi, wo] : draw_pairs(100, 3, true)) {
    EXPECT_TRUE(dark.eval(wi, wo, f));
    for (const double value : f) EXPECT_LT(value, 1e-9);
  }
  EXPECT_TRUE(dark.eval({0, 0, -1}, {0, 0, 1}, f));
}

TEST(KrigedNodes, TakeFewNodesAndNodesOfOnePlace) {
  Samples samples = measure(fixtures::Lambert{}, {.count = 1, .noise = 0});
  std::vector<double> f(3);
  kriged(samples).eval({0, 0, 1}, {0, 0, 1}, f);
  EXPECT_NEAR(f[0] / samples.values[0], 1, 0.01);
  for (int i = 0; i < 200; ++i) {
    samples.pairs.push_back(samples.pairs[0]);
    for (std::size_t c = 0; c < 3; ++c) samples.values.push_back(samples.values[c]);
  }
  kriged(samples).eval(samples.pairs[0].wi, samples.pairs[0].wo, f);
  EXPECT_NEAR(f[0] / samples.values[0], 1, 0.01);
}

TEST(KrigedNodes, NeedNodesAboveTheHorizon) {
  Samples samples = measure(fixtures::Lambert{}, {.count = 10, .noise = 0});
  samples.pairs.assign(10, {spherical_direction(radians(89.9), 0), {0, 0, 1}});
  const MeasuredNodes nodes = measured_nodes(samples);
  EXPECT_THROW(KrigedNodes(nodes, LogCovariance(true)), Error);
  EXPECT_THROW(likely_covariances(nodes), Error);
}

}  // namespace
}  // namespace burnish
