// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/fitting/choosing/between_incidences.h>
#include <burnish/fitting/fit.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/scattered_brdf.h>
#include <burnish/source.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

constexpr double kTapeIncidences_deg[] = {15, 30, 60};

/// A lobe about wi = wo that falls as the incidence grows, a highlight, and matt paint.
struct ScannedTape {
  static std::size_t channels() noexcept { return 1; }
  static bool isotropic() noexcept { return true; }
  static bool eval(Vec3 wi, Vec3 wo, std::span<double> f) noexcept {
    if (wi.z <= 0 || wo.z <= 0) return false;
    const double distance = angle_between(wi, wo) / radians(2);
    const double cos_h = half_vector(wi, wo).z;
    f[0] = 0.05 + 60 * std::pow(wi.z * wo.z, 2) * std::exp(-distance * distance) + 0.6 * std::pow(cos_h, 80);
    return true;
  }
};

/// Rings about wi, and a coarse lattice, at each incidence.
Samples scanned_tape() {
  Samples samples{.channels = 1, .isotropic = true, .pairs = {}, .values = {}};
  const auto add = [&](Vec3 wi, Vec3 wo) {
    double f = 0;
    if (!ScannedTape::eval(wi, wo, {&f, 1})) return;
    samples.pairs.push_back({wi, wo});
    samples.values.push_back(f);
  };
  for (const double theta_deg : kTapeIncidences_deg) {
    const double theta = radians(theta_deg);
    const Vec3 wi = spherical_direction(theta, 0), down = spherical_direction(theta + kHalfPi, 0);
    add(wi, wi);
    for (const double distance_deg : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 9.0})
      for (int k = 0; k < 12; ++k) {
        const double d = radians(distance_deg), phi = kTwoPi * k / 12;
        add(wi, std::cos(d) * wi + std::sin(d) * (std::cos(phi) * down + std::sin(phi) * Vec3{0, 1, 0}));
      }
    for (int theta_o = 0; theta_o <= 80; theta_o += 10)
      for (int phi_o = 0; phi_o <= 180; phi_o += 15)
        add(wi, spherical_direction(radians(theta_o), radians(phi_o)));
  }
  return samples;
}

TEST(BetweenIncidences, GoesFromOneIncidenceToTheNext) {
  const Samples samples = scanned_tape();
  const SampleSource source = from_samples(samples, false);
  const Samples expected = between_incidences(source, ScannedTape{});
  ASSERT_GT(expected.size(), 0u);
  const auto value = [](double theta_deg, double distance) {
    const Vec3 wi = spherical_direction(radians(theta_deg), 0),
               wo = spherical_direction(radians(theta_deg) + distance, 0);
    double f = 0;
    ScannedTape::eval(wi, wo, {&f, 1});
    return f;
  };
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto [wi, wo] = expected.pairs[i];
    const double theta_deg = degrees(theta_of(wi));
    EXPECT_LT(theta_deg, 60);
    for (const double incidence : kTapeIncidences_deg) EXPECT_GE(std::abs(theta_deg - incidence), 3.99);
    EXPECT_LE(angle_between(wi, wo), radians(10) + 1e-9);
    if (angle_between(wi, wo) > 1e-6) continue;
    // Below the first incidence the peak is constant. Between two incidences it is a weighted geometric mean of
    // theirs.
    const double low = theta_deg < 30 ? 15 : 30, share = (theta_deg - low) / low;
    const double truth = theta_deg < 15
                             ? value(15, 0)
                             : std::pow(value(low, 0), 1 - share) * std::pow(value(2 * low, 0), share);
    EXPECT_NEAR(expected.values[i], truth, 1e-9 * truth) << theta_deg;
  }

  // The expected samples follow the source's own.
  const SampleSource both = with_expected(source, expected, 0.5);
  ASSERT_EQ(both.count, samples.size() + expected.size());
  const std::size_t begin = samples.size() - 2;
  std::vector<DirectionPair> pairs(4);
  std::vector<double> values(4), weights(4);
  both.fill(begin, pairs, values, weights);
  EXPECT_THAT(values, testing::ElementsAre(samples.values[begin], samples.values[begin + 1],
                                           expected.values[0], expected.values[1]));
  EXPECT_THAT(weights, testing::ElementsAre(1, 1, 0.5, 0.5));
}

TEST(BetweenIncidences, ExpectsNothingWhereAnInstrumentStoodEverywhere) {
  Samples samples{.channels = 1, .isotropic = true, .pairs = {}, .values = {}};
  for (double theta_deg = 0; theta_deg < 80; theta_deg += 4)
    for (const double aside : {-1.0, 0.0, 1.0}) {
      samples.pairs.push_back(
          {spherical_direction(radians(theta_deg), 0), spherical_direction(radians(theta_deg + aside), 0)});
      samples.values.push_back(1);
    }
  EXPECT_EQ(between_incidences(from_samples(samples, false), ScannedTape{}).size(), 0u);
}

// Without the expected values, a product of factors was 1.5 or 10 times as high between the incidences.
TEST(BetweenIncidences, KeepsThePeakOfAFitNearTheTruth) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Fit made =
      fit({"tape", ScatteredBrdf(scanned_tape()), {}}, {.form = Budget{.bytes = 4096}, .smooth = 1e-7});
  for (double theta_deg = 0; theta_deg <= 60; theta_deg += 2.5) {
    const Vec3 w = spherical_direction(radians(theta_deg), 0);
    double truth = 0, found = 0;
    ScannedTape::eval(w, w, {&truth, 1});
    ASSERT_TRUE(made.model().eval(w, w, {&found, 1}));
    EXPECT_NEAR(found / truth, 1, 0.3) << theta_deg;
  }
}

}  // namespace
}  // namespace burnish
