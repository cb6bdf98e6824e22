// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/mbsdf.h>
#include <burnish/math/angles.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/files.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

std::string block(std::string_view keyword, std::uint32_t type, std::uint32_t theta, std::uint32_t phi,
                  const std::vector<float>& values) {
  std::string bytes(keyword);
  append(bytes, type);
  append(bytes, theta);
  append(bytes, phi);
  for (const float value : values) append(bytes, value);
  return bytes;
}

const std::string kStart = "NVIDIA ARC MBSDF V1\n";
const std::string kReflection = "MBSDF_DATA_REFLECTION=\n";
const std::string kTransmission = "MBSDF_DATA_TRANSMISSION=\n";

std::string mbsdf_error(const std::string& bytes) {
  return error_of([&] { parse_mbsdf(memory_file(bytes)); });
}

TEST(Mbsdf, PutsEntriesAtCellCentres) {
  // The block is [theta_in][theta_out][phi], 2 x 2 x 2.
  const auto file = parse_mbsdf(memory_file(kStart + block(kReflection, 0, 2, 2, {1, 2, 3, 4, 5, 6, 7, 8})));
  EXPECT_EQ(file.findings.sample_count, 8u);
  EXPECT_EQ(file.table.channels(), 1);
  EXPECT_TRUE(file.table.isotropic());
  const double low = kPi / 8, high = 3 * kPi / 8;
  double f;
  ASSERT_TRUE(
      file.table.eval(spherical_direction(high, 1), spherical_direction(low, 1 + 0.75 * kPi), {&f, 1}));
  EXPECT_NEAR(f, 6, 1e-9);
  ASSERT_TRUE(
      file.table.eval(spherical_direction(low, 1), spherical_direction(high, 1 - 0.25 * kPi), {&f, 1}));
  EXPECT_NEAR(f, 3, 1e-9);
  // Every direction pair above the horizon is covered.
  EXPECT_TRUE(file.table.eval({0, 0, 1}, spherical_direction(1.57, 0), {&f, 1}));
}

TEST(Mbsdf, TakesTheKeyOfOlderFilesForReflection) {
  const MbsdfFile file = parse_mbsdf(memory_file(kStart + block("MBSDF_DATA=\n", 0, 1, 1, {3})));
  EXPECT_EQ(file.table.values, std::vector<float>{3});
  EXPECT_TRUE(file.findings.left_out.empty());
}

TEST(Mbsdf, SaysThatASecondBlockIsLeftOut) {
  const std::string reflection = block(kReflection, 0, 1, 1, {3}),
                    transmission = block(kTransmission, 0, 1, 1, {9});
  const auto left_out = [](const std::string& text) {
    const MbsdfFile file = parse_mbsdf(memory_file(kStart + text));
    EXPECT_EQ(file.table.values, std::vector<float>{3});
    return file.findings.left_out;
  };
  EXPECT_EQ(left_out(transmission + reflection), std::vector<std::string>{"transmission"});
  EXPECT_EQ(left_out(reflection + transmission), std::vector<std::string>{"transmission"});
  EXPECT_EQ(left_out(reflection + "\n" + transmission), std::vector<std::string>{"transmission"});
  EXPECT_EQ(left_out(reflection + block("MBSDF_DATA=\n", 0, 1, 1, {4})),
            std::vector<std::string>{"a second block of reflection"});
}

TEST(Mbsdf, SkipsMetadataAndTransmission) {
  const std::string transmission = block(kTransmission, 0, 1, 1, {9});
  const std::string reflection = block(kReflection, 1, 1, 1, {1, 2, 3});
  for (const std::string& bytes :
       {kStart + "name=\"blue\"\n" + transmission + reflection, kStart + reflection + transmission,
        kStart + reflection + "\n" + transmission}) {
    const auto file = parse_mbsdf(memory_file(bytes));
    std::array<double, 3> f;
    ASSERT_TRUE(file.table.eval({0, 0, 1}, {0, 0, 1}, f));
    EXPECT_EQ(f, (std::array<double, 3>{1, 2, 3}));
  }
}

TEST(Mbsdf, ReadsTransmissionWhereItIsAskedForOrAlone) {
  const std::string transmission = block(kTransmission, 0, 1, 2, {9, 10}),
                    reflection = block(kReflection, 1, 1, 1, {1, 2, 3});
  const OpenOptions options{.part = BsdfPart::transmission_front};
  for (const std::string& bytes :
       {kStart + transmission + reflection, kStart + reflection + transmission, kStart + transmission}) {
    const MbsdfFile file = parse_mbsdf(memory_file(bytes), options);
    EXPECT_EQ(file.table.values, (std::vector<float>{9, 10}));
    EXPECT_TRUE(file.findings.transmits());
    EXPECT_TRUE(file.findings.warnings.empty());
    // Light that goes straight on is at azimuth pi.
    const Vec3 wi = spherical_direction(0.7, 2);
    double f;
    ASSERT_TRUE(file.table.eval(wi, mirror(wi), {&f, 1}));
    EXPECT_EQ(f, 10);
  }
  const MbsdfFile alone = parse_mbsdf(memory_file(kStart + transmission));
  EXPECT_TRUE(alone.findings.transmits());
  EXPECT_THAT(alone.findings.warnings, testing::ElementsAre(HasSubstr("no reflection: transmission-front")));
  EXPECT_THAT(error_of([&] { parse_mbsdf(memory_file(kStart + reflection), options); }),
              HasSubstr("expected part transmission-front, found reflection-front"));
}

TEST(Mbsdf, CountsAndKeepsNegatives) {
  const std::string bytes = kStart + block(kReflection, 0, 1, 2, {-0.5f, 2});
  const auto file = parse_mbsdf(memory_file(bytes));
  EXPECT_EQ(file.findings.negative_count, 1u);
  EXPECT_EQ(file.findings.most_negative, -0.5);
  EXPECT_EQ(file.table.values[0], -0.5f);
}

TEST(Mbsdf, WritesWhatItReads) {
  for (const std::size_t channels : {1, 3}) {
    AngleTable table = tabulate_angles(fixtures::Glossy{.count = channels}, mbsdf_layout(5, 7));
    ASSERT_TRUE(fits_mbsdf(table));
    EXPECT_EQ(parse_mbsdf(memory_file(format_mbsdf(table))).table.values, table.values);
    const MbsdfFile through = parse_mbsdf(memory_file(format_mbsdf(table, BsdfPart::transmission_front)));
    EXPECT_EQ(through.table.values, table.values);
    EXPECT_TRUE(through.findings.transmits());
    std::fill_n(table.values.begin(), channels, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(parse_mbsdf(memory_file(format_mbsdf(table))).table.values[0], 0);
  }
  AngleTable other = mbsdf_layout(5, 7);
  other.folded = false;
  EXPECT_FALSE(fits_mbsdf(other));
  other = mbsdf_layout(5, 7);
  other.axes[2].nodes[1] += 0.01;
  EXPECT_THROW(format_mbsdf(other), Error);
}

TEST(Mbsdf, RefusesWhatIsNoMbsdf) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(mbsdf_error("NVIDIA ARC MBSDF V2\n"), HasSubstr("NVIDIA ARC MBSDF V1"));
  EXPECT_THAT(mbsdf_error(kStart), HasSubstr("a line of text"));
  EXPECT_THAT(mbsdf_error(kStart + block(kReflection, 0, 2, 2, {1, 2, 3})), HasSubstr("32 bytes of values"));
  EXPECT_THAT(mbsdf_error(kStart + block(kReflection, 0, 1, 1, {1, 2})), HasSubstr("end of the file"));
  EXPECT_THAT(mbsdf_error(kStart + block(kReflection, 7, 1, 1, {1})), HasSubstr("block type"));
  EXPECT_THAT(mbsdf_error(kStart + block(kReflection, 0, 0, 1, {})), HasSubstr("resolution in"));
  EXPECT_THAT(mbsdf_error(kStart + block(kReflection, 0, 0xffffffff, 0xffffffff, {1})),
              HasSubstr("resolution in"));
  EXPECT_THAT(mbsdf_error(kStart + block(kReflection, 0, 2048, 2048, {1})), HasSubstr("bytes of values"));
  EXPECT_THAT(mbsdf_error(kStart + block(kReflection, 0, 1, 1, {nan})),
              HasSubstr("offset 55: expected a finite value"));
}

TEST(Mbsdf, ReadsCarPaintWithItsPeakInTheMirrorDirection) {
  BURNISH_NEEDS_DATA();
  const auto file = parse_mbsdf(read_file(data_folder() / "mbsdf" / "carpaint_blue.mbsdf"));
  EXPECT_EQ(file.findings.sample_count, 45u * 45 * 90);
  EXPECT_NEAR(static_cast<double>(file.findings.negative_count) / (45 * 45 * 90 * 3), 1 / 7.0, 0.01);
  std::array<double, 3> f;
  for (const double theta : {20.0, 40.0, 60.0}) {
    const Vec3 wi = spherical_direction(radians(theta), 0);
    double best = 0;
    Vec3 brightest;
    for (int t = 1; t < 90; ++t)
      for (int p = 0; p < 360; p += 2) {
        const Vec3 wo = spherical_direction(radians(t), radians(p));
        ASSERT_TRUE(file.table.eval(wi, wo, f));
        if (f[1] > best) {
          best = f[1];
          brightest = wo;
        }
      }
    EXPECT_LT(degrees(angle_between(brightest, mirror(wi))), 5) << theta;
  }
}

}  // namespace
}  // namespace burnish
