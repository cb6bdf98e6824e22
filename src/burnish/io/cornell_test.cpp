// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/cornell.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/scattered_brdf.h>
#include <burnish/testing/files.h>

namespace burnish {
namespace {

using testing::HasSubstr;

constexpr std::string_view kCornell =
    "# Maker\n# Paint\n3\n400\n500 600\n\n0.5 0 0.25 3.14159265 0.1 0.2 0.3\n0.5 0 0.75 0\n  -0.1 0.4 0.5\n";

TEST(Cornell, ReadsWrappedRowsAndKeepsSpectraOnRequest) {
  OpenOptions options;
  options.keep_spectral = true;
  const SampleFile file = parse_cornell(memory_file(kCornell), options);
  EXPECT_TRUE(looks_like_cornell(kCornell));
  ASSERT_EQ(file.samples.size(), 2u);
  EXPECT_EQ(file.samples.channels, 3);
  EXPECT_TRUE(file.samples.isotropic);
  EXPECT_EQ(file.findings.lambda_nm, (std::vector<double>{400, 500, 600}));
  EXPECT_EQ(file.findings.description, "Maker, Paint");
  EXPECT_NEAR(length(file.samples.pairs[0].wi - spherical_direction(0.5, 0)), 0, 1e-15);
  EXPECT_NEAR(length(file.samples.pairs[0].wo - spherical_direction(0.25, kPi)), 0, 1e-8);
  EXPECT_EQ(file.samples.at(1)[0], -0.1);  // noise is kept
  EXPECT_EQ(file.samples.at(1)[2], 0.5);
  EXPECT_EQ(file.findings.negative_count, 1u);
  EXPECT_EQ(file.findings.most_negative, -0.1);
}

TEST(Cornell, TurnsFlatSpectraIntoWhite) {
  const SampleFile file = parse_cornell(memory_file("2\n400 700\n0.1 0 0.2 0 0.25 0.25\n"), {});
  EXPECT_EQ(file.samples.channels, 3);
  for (const double value : file.samples.at(0)) EXPECT_NEAR(value, 0.25, 1e-12);
  EXPECT_TRUE(file.findings.lambda_nm.empty());
  EXPECT_EQ(file.findings.illuminant, "equal energy");
}

TEST(Cornell, NamesTheLineOfWhatIsWrong) {
  const auto error = [](std::string_view text) {
    return error_of([&] { parse_cornell(memory_file(text), {}); });
  };
  EXPECT_THAT(error("1\n400\n0.1 0 0.2 0 x\n"),
              HasSubstr("line 3: expected a finite number for a value, found 'x'"));
  EXPECT_THAT(error("1\n400\n0.1 0 0.2 0\n"), HasSubstr("end of the file"));
  EXPECT_THAT(error("1\n400\n0.1 0 0.2 0 nan\n"), HasSubstr("finite"));
  EXPECT_THAT(error("1\n400\n1.6 0 0.2 0 1\n"), HasSubstr("theta_i in [0, pi/2)"));
  EXPECT_THAT(error("1\n400\n0.1 0 0.2 0 1 2\n"), HasSubstr("end of the line"));
  EXPECT_THAT(error("99999999\n400\n"), HasSubstr("number of wavelengths in [1, 1024]"));
  EXPECT_THAT(error("2\n500 400\n0.1 0 0.2 0 1 2\n"), HasSubstr("increasing wavelengths"));
  EXPECT_THAT(error("2\n500 5e10\n0.1 0 0.2 0 1 2\n"),
              HasSubstr("test.file: wavelengths: expected increasing"));
  EXPECT_THAT(error("1\n400\n"), HasSubstr("at least one measurement"));
}

TEST(Cornell, ReadsThreePaintsWithAPeakOppositeTheLight) {
  BURNISH_NEEDS_DATA();
  for (const char* name : {"cayman.brdf", "krylon_blue.brdf", "mystique.brdf"}) {
    const SampleFile file = parse_cornell(read_file(data_folder() / "cornell" / name), {});
    EXPECT_EQ(file.samples.size(), 1439u);
    EXPECT_NEAR(degrees(file.findings.theta_i_min), 10, 0.1);
    EXPECT_NEAR(degrees(file.findings.theta_i_max), 80, 0.1);
    EXPECT_LT(degrees(file.findings.theta_o_max), 80);
    // The brightest sample is a grazing one, within a few degrees of the mirror direction.
    std::size_t brightest = 0;
    for (std::size_t i = 0; i < file.samples.size(); ++i)
      if (file.samples.at(i)[1] > file.samples.at(brightest)[1]) brightest = i;
    const auto& [wi, wo] = file.samples.pairs[brightest];
    EXPECT_LT(degrees(angle_between(mirror(wi), wo)), 6) << name;
    EXPECT_GT(degrees(theta_of(wi)), 60) << name;
    // The same peak, interpolated, stands at 50 degrees.
    const ScatteredBrdf brdf(file.samples, SampleRule::mean_in_half_difference);
    const Vec3 light = spherical_direction(radians(50), 0);
    std::array<double, 3> at_mirror, aside;
    ASSERT_TRUE(brdf.eval(light, mirror(light), at_mirror));
    ASSERT_TRUE(brdf.eval(light, spherical_direction(radians(50), radians(100)), aside));
    EXPECT_GT(at_mirror[1], 5 * aside[1]) << name;
  }
}

// scattered_brdf.h states these figures for the default space.
TEST(Cornell, PaintsPredictTheirHeldOutSamples) {
  BURNISH_NEEDS_DATA();
  const std::array<std::pair<const char*, double>, 3> paints = {
      {{"cayman.brdf", 0.16}, {"krylon_blue.brdf", 0.17}, {"mystique.brdf", 0.11}}};
  for (const auto& [name, bound] : paints) {
    const Samples samples = parse_cornell(read_file(data_folder() / "cornell" / name), {}).samples;
    std::vector<std::size_t> kept, held_out;
    for (std::size_t i = 0; i < samples.size(); ++i) (i % 10 == 0 ? held_out : kept).push_back(i);
    const ScatteredBrdf brdf(samples, kept, SampleRule::mean_in_half_difference);
    double sum = 0;
    for (const std::size_t i : held_out) {
      std::array<double, 3> f;
      ASSERT_TRUE(brdf.eval(samples.pairs[i].wi, samples.pairs[i].wo, f));
      sum += std::abs(std::log((f[1] + 1e-3) / (std::max(samples.at(i)[1], 0.0) + 1e-3)));
    }
    EXPECT_LT(std::exp(sum / static_cast<double>(held_out.size())) - 1, bound) << name;
  }
}

}  // namespace
}  // namespace burnish
