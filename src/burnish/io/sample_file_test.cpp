// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/io/sample_file.h>
#include <burnish/math/angles.h>

namespace burnish {
namespace {

SampleFile scattered(std::size_t channels, std::vector<double> lambda_nm = {}) {
  SampleFile file{.samples = {.channels = channels, .isotropic = true, .pairs = {}, .values = {}},
                  .findings = {}};
  file.findings.lambda_nm = std::move(lambda_nm);
  for (const auto& [theta_i, theta_o] : {std::pair(0.3, 1.1), {0.5, 0.2}, {0.4, 0.7}}) {
    file.samples.pairs.push_back({spherical_direction(theta_i, 1), spherical_direction(theta_o, 2)});
    file.samples.values.insert(file.samples.values.end(), channels, 0.5);
  }
  return file;
}

TEST(FinishSamples, CountsWhatIsThereAndKeepsNegatives) {
  SampleFile file = scattered(3);
  file.samples.values[1] = -0.25;
  file.samples.values[7] = -2;
  const std::vector<double> before = file.samples.values;
  finish_samples("a.csv", {}, file);
  EXPECT_EQ(file.samples.values, before);
  EXPECT_EQ(file.findings.sample_count, 3u);
  EXPECT_EQ(file.findings.negative_count, 2u);
  EXPECT_EQ(file.findings.most_negative, -2);
  EXPECT_NEAR(file.findings.theta_i_min, 0.3, 1e-15);
  EXPECT_NEAR(file.findings.theta_i_max, 0.5, 1e-15);
  EXPECT_NEAR(file.findings.theta_o_min, 0.2, 1e-15);
  EXPECT_NEAR(file.findings.theta_o_max, 1.1, 1e-15);
}

// A spectrum that is the same everywhere is white: three equal channels of its value.
TEST(FinishSamples, TurnsSpectraIntoColoursUnlessTheyAreKept) {
  const std::vector<double> lambda_nm{420, 500, 560, 630, 700};
  SampleFile colours = scattered(5, lambda_nm), kept = scattered(5, lambda_nm), one = scattered(1, {550});
  finish_samples("a.brdf", {}, colours);
  EXPECT_EQ(colours.samples.channels, 3u);
  ASSERT_EQ(colours.samples.values.size(), 9u);
  for (const double value : colours.samples.values) EXPECT_NEAR(value, 0.5, 1e-9);
  EXPECT_TRUE(colours.findings.lambda_nm.empty());
  EXPECT_FALSE(colours.findings.illuminant.empty());
  finish_samples("a.brdf", {.keep_spectral = true}, kept);
  EXPECT_EQ(kept.samples.channels, 5u);
  EXPECT_EQ(kept.findings.lambda_nm, lambda_nm);
  finish_samples("a.brdf", {}, one);  // a single wavelength is no spectrum
  EXPECT_EQ(one.samples.channels, 1u);
}

TEST(FinishSamples, RefusesNoSamplesAndWavelengthsOutOfOrder) {
  SampleFile none;
  EXPECT_THROW(finish_samples("a", {}, none), Error);
  for (const std::vector<double>& lambda_nm :
       {std::vector<double>{500, 400}, {500, 500}, {-1, 500}, {0, 500}}) {
    SampleFile file = scattered(2, lambda_nm);
    EXPECT_THROW(finish_samples("a", {.keep_spectral = true}, file), Error) << lambda_nm[0];
  }
}

TEST(SameIncidentAzimuth, LooksAtAzimuthsAndNotAtTheNormal) {
  Samples samples{.channels = 1, .isotropic = false, .pairs = {}, .values = {}};
  EXPECT_TRUE(same_incident_azimuth(samples));
  const auto add = [&](double theta, double phi) {
    samples.pairs.push_back({spherical_direction(theta, phi), {0, 0, 1}});
  };
  add(0.3, 1e-8);
  add(1.2, -1e-8);  // on the other side of 2 pi
  add(0, 2);
  EXPECT_TRUE(same_incident_azimuth(samples));
  add(0.3, kPi);
  EXPECT_FALSE(same_incident_azimuth(samples));
}

TEST(CoverageGaps, NameWhatASurveyLeavesOut) {
  const auto survey = [](auto pair_of) {
    Samples samples{.channels = 1, .isotropic = true, .pairs = {}, .values = {}};
    for (int i = 0; i < 12; ++i) {
      const auto [theta_i, theta_o, phi_o] = pair_of(0.1 * i);
      samples.pairs.push_back({spherical_direction(theta_i, 1), spherical_direction(theta_o, 1 + phi_o)});
      samples.values.push_back(1);
    }
    return samples;
  };
  using Angles = std::array<double, 3>;
  using testing::ElementsAre;
  using testing::HasSubstr;
  EXPECT_THAT(coverage_gaps(survey([](double t) {
                return Angles{t, 0, 0};
              })),
              ElementsAre(HasSubstr("One angle of view only, theta_o = 0 degrees")));
  EXPECT_THAT(coverage_gaps(survey([](double t) {
                return Angles{kHalfPi / 2, t, 5 * t};
              })),
              ElementsAre(HasSubstr("One angle of incidence only, theta_i = 45 degrees")));
  EXPECT_THAT(coverage_gaps(survey([](double t) {
                return Angles{t, 1.2 - t, kPi};
              })),
              ElementsAre(HasSubstr("In the plane of incidence only")));
  EXPECT_THAT(coverage_gaps(survey([](double t) { return Angles{t, 1.2 - t, 3 * t}; })), testing::IsEmpty());
  Samples few = survey([](double t) { return Angles{t, 0, 0}; });
  few.pairs.resize(9);
  EXPECT_THAT(coverage_gaps(few), testing::IsEmpty());
}

}  // namespace
}  // namespace burnish
