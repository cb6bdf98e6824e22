// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <burnish/fitting/one_lobe/cross_validation.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

// One pair of directions, measured as one value by samples of even number and as another by odd ones: each fold is
// predicted as the other.
TEST(CrossValidation, PredictsAFoldFromTheOthers) {
  constexpr double kEvenValue = 0.5, kOddValue = 0.2, kFitFloor = 1e-4, kScoreFloor = 1e-2;
  constexpr std::size_t kMeasured = 7;  // odd: exchanged pairs have the other parity
  SampleSource source{
      .count = 2 * kMeasured, .distinct = kMeasured, .channels = 1, .isotropic = true, .fill = {}};
  source.fill = [](std::size_t begin, std::span<DirectionPair> pairs, std::span<double> values,
                   std::span<double> weights) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const bool exchanged = begin + i >= kMeasured;
      const Vec3 w{0.6, 0, 0.8}, v{0, 0.28, 0.96};
      pairs[i] = exchanged ? DirectionPair{v, w} : DirectionPair{w, v};
      values[i] = (begin + i) % kMeasured % 2 == 0 ? kEvenValue : kOddValue;
      weights[i] = 1;
    }
  };
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=3", "q=3"}, true);
  const double error = held_out_error(
      source, spec,
      {.smooth = 1e-3, .floor = kFitFloor, .error_floor = kScoreFloor, .format = TableFormat::single}, 2);
  // fits are to log(f + the fit's floor)
  const auto error_of = [&](double seen, double held_out) {
    return std::abs(std::log((held_out + kScoreFloor) / (seen + kFitFloor + kScoreFloor)));
  };
  const double expected = (4 * error_of(kOddValue, kEvenValue) + 3 * error_of(kEvenValue, kOddValue)) / 7;
  EXPECT_NEAR(error, expected, 1e-5 * expected);  // the ridge pulls by 1e-7 of a logarithm, floats round
}

TEST(CrossValidation, TriesBothSidesOfTheBestAndEachTablesShare) {
  const AnalyticBrdf brdf = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3");
  const Samples samples = measure(brdf, {.count = 200, .noise = 0.1, .seed = 2});
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=4", "q=8"}, true);
  HomomorphicOptions options;
  double last = 0;
  options.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
  };
  const SampleSource source = from_samples(samples, true);
  const std::vector<SmoothTrial> trials = choose_smoothness(source, spec, options);
  EXPECT_GT(last, 0);
  const SmoothTrial& best = trials.front();
  bool shared = false;
  std::set<double> decades, between;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    ASSERT_EQ(trials[i].shares.size(), spec.tables.size());
    if (i > 0) {
      EXPECT_GE(trials[i].error, trials[i - 1].error);
    }
    const double decade = std::log10(trials[i].smooth), off = std::abs(decade - std::round(decade));
    (off < 0.1 ? decades : between).insert(off < 0.1 ? std::round(decade) : std::floor(decade) + 0.5);
    shared |= trials[i].shares != std::vector<double>(spec.tables.size(), 1.0);
  }
  EXPECT_TRUE(shared);
  // from 10^-1 on, two decades beyond the best of them; half a decade either way
  EXPECT_EQ(*decades.rbegin(), -1);
  ASSERT_EQ(between.size(), 2u);
  EXPECT_NEAR(*between.rbegin() - *between.begin(), 1, 1e-9);
  const double best_decade = *between.begin() + 0.5;
  EXPECT_EQ(*decades.begin(), best_decade - 2);
  // and what stands there is what those options give
  ModelSpec chosen = spec;
  for (std::size_t t = 0; t < chosen.tables.size(); ++t) chosen.tables[t].smooth_share = best.shares[t];
  options.smooth = best.smooth;
  EXPECT_EQ(held_out_error(source, chosen, options, 5), best.error);
}

TEST(CrossValidation, NoisyDataGetSmootherTables) {
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=16", "q=32"}, true);
  const AnalyticBrdf brdf = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3");
  const auto chosen = [&](double noise) {
    const Samples samples = measure(brdf, {.count = 1000, .noise = noise, .seed = 1});
    const std::vector<SmoothTrial> trials = choose_smoothness(from_samples(samples, true), spec, {});
    for (const SmoothTrial& trial : trials) EXPECT_GE(trial.error, trials.front().error);
    return trials.front();
  };
  const SmoothTrial clean = chosen(0), noisy = chosen(0.5);
  EXPECT_LT(clean.smooth, noisy.smooth);
  EXPECT_LT(clean.error, noisy.error);
}

}  // namespace
}  // namespace burnish
