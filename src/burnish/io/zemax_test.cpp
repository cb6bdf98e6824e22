// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/zemax.h>
#include <burnish/math/angles.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/files.h>

namespace burnish {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const std::string kHeader =
    "# Sample: "
    "paint\nSource\tMeasured\nSymmetry\tPlaneSymmetrical\nSpectralContent\tMonochrome\nScatterType\tBRDF\n"
    "SampleRotation\t1\n0\nAngleOfIncidence\t2\n10 30\nScatterAzimuth\t3\n0 90 180\nScatterRadial\t2\n0 "
    "10\n\n";
const std::string kData =
    "Monochrome\nDataBegin\nTIS 0.1\n1 2\n1 3\n1 4\nTIS 0.2\n5 6\n5 -7\n5 0.000e+00\nDataEnd\n";

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  return text.replace(text.find(what), what.size(), with);
}

std::string zemax_error(const std::string& text) {
  return error_of([&] { parse_zemax(memory_file(text)); });
}

// Returns a table of f_r = 0.1 / pi to 90 degrees and beyond; its TIS states more.
std::string lambertian(std::string_view tis) {
  std::string text =
      "# Sample: white\n#  kept,\tas it is "
      "\nSource\tMeasured\nSymmetry\tPlaneSymmetrical\nSpectralContent\tMonochrome\n"
      "ScatterType\tBRDF\nSampleRotation\t1\n0\nAngleOfIncidence\t2\n0\t30\nScatterAzimuth\t3\n0\t90\t180\nSc"
      "atterRadial\t3\n"
      "0\t75\t150\n\nMonochrome\nDataBegin\n";
  for (int block = 0; block < 2; ++block) {
    text += fmt::format("TIS {}\n", tis);
    for (int row = 0; row < 3; ++row) text += "0.0318310\t0.0318310\t0.0318310\n";
  }
  return text + "DataEnd\n";
}

TEST(Zemax, SaysWhereValuesDoNotIntegrateToTis) {
  const auto off = parse_zemax(memory_file(lambertian("0.3")));
  EXPECT_THAT(off.findings.warnings,
              ElementsAre(testing::AllOf(HasSubstr("The values integrate to 10 % at theta_i = "),
                                         HasSubstr("TIS says 30 %"))));
  const auto right = parse_zemax(memory_file(lambertian("0.1")));
  EXPECT_THAT(right.findings.warnings, IsEmpty());
  EXPECT_THAT(right.findings.conventions, Contains("The values integrate to the stated TIS."));
  EXPECT_EQ(right.table.values, off.table.values);
  EXPECT_THAT(parse_zemax(memory_file(lambertian("0"))).findings.warnings, IsEmpty()) << "not stated";
}

TEST(Zemax, KeepsCommentsAndAnglesAsTheyAreWritten) {
  const auto file = parse_zemax(memory_file(lambertian("0.1")));
  EXPECT_DOUBLE_EQ(file.findings.theta_o_max, kHalfPi) << "what lies below the horizon is no coverage";
  const std::string again = format_zemax(file.table, "white", file.findings.comments);
  EXPECT_THAT(again, StartsWith("# Sample: white\n#  kept,\tas it is \nSource"));
  EXPECT_THAT(again, HasSubstr("AngleOfIncidence\t2\n0\t30\n"));
  EXPECT_THAT(again, HasSubstr("\n0\t75\t150\n"));
  EXPECT_EQ(parse_zemax(memory_file(again)).table.axes[1].nodes, file.table.axes[1].nodes);
}

TEST(Zemax, ReadsValuesAroundTheMirrorDirection) {
  EXPECT_TRUE(looks_like_zemax(kHeader));
  const auto file = parse_zemax(memory_file(kHeader + kData));
  EXPECT_EQ(file.findings.description, "paint");
  EXPECT_EQ(file.findings.sample_count, 12u);
  EXPECT_EQ(file.findings.hole_count, 1u);
  EXPECT_EQ(file.findings.negative_count, 1u);
  EXPECT_TRUE(file.table.isotropic());
  double f;
  const double phi = 0.3;
  for (const int side : {-1, 1}) {  // the table is folded
    const Vec3 wi = spherical_direction(radians(10), phi);
    ASSERT_TRUE(file.table.eval(wi, around_specular(radians(10), phi, 0, radians(10)), {&f, 1}));
    EXPECT_NEAR(f, 2, 1e-6);
    ASSERT_TRUE(file.table.eval(wi, around_specular(radians(10), phi, side * kHalfPi, radians(10)), {&f, 1}));
    EXPECT_NEAR(f, 3, 1e-6);
  }
  // The hole at 30 degrees takes no part, so the mirror direction's value is left.
  ASSERT_TRUE(file.table.eval(spherical_direction(radians(30), 0),
                              around_specular(radians(30), 0, kPi, radians(5)), {&f, 1}));
  EXPECT_NEAR(f, 5, 1e-6);
  // Directions up to half a step beyond the incidences are covered.
  EXPECT_TRUE(
      file.table.eval(spherical_direction(radians(39), 0), spherical_direction(radians(39), kPi), {&f, 1}));
  EXPECT_FALSE(
      file.table.eval(spherical_direction(radians(41), 0), spherical_direction(radians(41), kPi), {&f, 1}));
}

TEST(Zemax, TurnsTheLightWithTheSample) {
  std::string text = replaced(kHeader + kData, "SampleRotation\t1\n0\n", "SampleRotation\t2\n0 90\n");
  text = replaced(text, "AngleOfIncidence\t2\n10 30\n", "AngleOfIncidence\t1\n10\n");
  const auto file = parse_zemax(memory_file(text));
  EXPECT_FALSE(file.table.isotropic());
  double f;
  ASSERT_TRUE(file.table.eval(spherical_direction(radians(10), kHalfPi),
                              spherical_direction(radians(10), -kHalfPi), {&f, 1}));
  EXPECT_NEAR(f, 1, 1e-6);
  ASSERT_TRUE(
      file.table.eval(spherical_direction(radians(10), kPi), spherical_direction(radians(10), 0), {&f, 1}));
  EXPECT_NEAR(f, 5, 1e-6);
}

TEST(Zemax, TurnsWhiteXyzIntoGreyRgb) {
  std::string text = replaced(kHeader, "Monochrome", "XYZ");
  text = replaced(text, "AngleOfIncidence\t2\n10 30\n", "AngleOfIncidence\t1\n10\n");
  text = replaced(text, "ScatterAzimuth\t3\n0 90 180\n", "ScatterAzimuth\t1\n0\n");
  for (const char* white : {"0.95047", "1.0", "1.08883"})
    text += fmt::format("TristimulusX\nDataBegin\nTIS 1\n{} {}\nDataEnd\n", white, white);
  const auto file = parse_zemax(memory_file(text));
  std::array<double, 3> f;
  ASSERT_TRUE(file.table.eval(spherical_direction(radians(10), 0), spherical_direction(radians(10), kPi), f));
  for (const double value : f) EXPECT_NEAR(value, 1, 1e-4);
}

// Returns the rotations, incidences and azimuths of a coarse file.
AngleTable coarse_layout(bool isotropic) {
  AngleTable layout;
  layout.frame = AngleTable::Frame::specular;
  layout.folded = isotropic;
  layout.axes = {make_axis(isotropic ? std::vector{kHalfPi} : std::vector{0.0, kHalfPi, kPi}, kTwoPi),
                 make_axis({0, radians(30), radians(80)}),
                 isotropic ? make_axis({0, kHalfPi, kPi}) : make_axis({0, kHalfPi, kPi, 1.5 * kPi}, kTwoPi),
                 make_axis({0, radians(3), radians(20)})};
  return layout;
}

TEST(Zemax, WritesWhatItReads) {
  for (const std::size_t channels : {1, 3})
    for (const bool isotropic : {true, false}) {
      fixtures::Glossy glossy{.a = 20, .b = isotropic ? 20.0 : 5.0, .count = channels};
      const AngleTable table = tabulate_angles(glossy, coarse_layout(isotropic));
      ASSERT_TRUE(fits_zemax(table));
      const auto file = parse_zemax(memory_file(format_zemax(table, "some\nname")));
      EXPECT_EQ(file.findings.description, "some?name");
      EXPECT_EQ(file.table.channels(), channels);
      EXPECT_EQ(file.table.isotropic(), isotropic);
      EXPECT_EQ(file.table.folded, isotropic);
      ASSERT_EQ(file.table.values.size(), table.values.size());
      std::size_t holes = 0;
      for (std::size_t i = 0; i < table.values.size(); ++i) {
        EXPECT_EQ(std::isnan(file.table.values[i]), std::isnan(table.values[i]));
        if (!std::isnan(table.values[i])) {
          EXPECT_NEAR(file.table.values[i], table.values[i], 1e-6 * table.values[i]);
        }
        holes += std::isnan(table.values[i]);
      }
      EXPECT_GT(holes, 0u);
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t i = 0; i < table.axes[k].nodes.size(); ++i)
          EXPECT_NEAR(file.table.axes[k].nodes[i], table.axes[k].nodes[i], 1e-12);
    }
  EXPECT_THROW(format_zemax(AngleTable{}, ""), Error);
}

// Zero is no hole, saturated colours keep all channels, and the total is the albedo.
TEST(Zemax, WritesZeroSaturationAndTotals) {
  AngleTable table = tabulate_angles(fixtures::Lambert{}, zemax_layout(true));
  const std::string white = format_zemax(table, "");
  const std::string tis = white.substr(white.find("TIS\t") + 4, 8);
  // TIS is X of the albedos 0.8, 0.5 and 0.2.
  EXPECT_NEAR(std::stod(tis), 0.4124564 * 0.8 + 0.3575761 * 0.5 + 0.1804375 * 0.2, 0.01);
  for (std::size_t i = 0; i < table.values.size(); i += 3) {
    if (std::isnan(table.values[i])) continue;
    const std::array<float, 3> value = i % 2 ? std::array{0.0f, 0.0f, 0.0f} : std::array{1.0f, 1e-3f, 1e-4f};
    std::copy(value.begin(), value.end(), table.values.begin() + static_cast<std::ptrdiff_t>(i));
  }
  const AngleTable back = parse_zemax(memory_file(format_zemax(table, ""))).table;
  for (std::size_t i = 0; i < table.values.size(); ++i)
    if (std::isnan(table.values[i])) {
      EXPECT_TRUE(std::isnan(back.values[i]));
    } else {
      EXPECT_NEAR(back.values[i], table.values[i], 1e-6 * table.values[i] + 1e-29);
    }
}

TEST(Zemax, ReadsAndWritesABtdfAsTransmission) {
  const std::string text = replaced(lambertian("0.1"), "BRDF", "BTDF");
  const ZemaxFile file = parse_zemax(memory_file(text));
  EXPECT_EQ(file.findings.format, "Zemax tabular BTDF");
  EXPECT_TRUE(file.findings.transmits());
  EXPECT_EQ(file.table.values, parse_zemax(memory_file(lambertian("0.1"))).table.values);
  const std::string again = format_zemax(file.table, "", {}, BsdfPart::transmission_front);
  EXPECT_THAT(again, HasSubstr("ScatterType\tBTDF\n"));
  EXPECT_EQ(parse_zemax(memory_file(again)).table.values, file.table.values);
  EXPECT_THAT(error_of([&] { parse_zemax(memory_file(text), {.part = BsdfPart::reflection_front}); }),
              HasSubstr("expected part reflection-front, found transmission-front"));
}

// Ansys scales each block to its TIS.
TEST(Zemax, ScalesBlocksToTisWhereAsked) {
  const std::string text = replaced(lambertian("0.3"), "TIS 0.3", "TIS 0.2");  // the first block's
  const ZemaxFile scaled = parse_zemax(memory_file(text), {.scale_to_tis = true});
  EXPECT_THAT(scaled.findings.warnings, IsEmpty());
  EXPECT_THAT(scaled.findings.conventions, Contains(StartsWith("The values were scaled to TIS, by 2")));
  const std::size_t block = scaled.table.values.size() / 2;
  EXPECT_NEAR(scaled.table.values.front(), 0.063662, 0.0005);
  EXPECT_NEAR(scaled.table.values[block], 0.095493, 0.0008);
}

TEST(Zemax, SaysWhatIsWrong) {
  EXPECT_THAT(zemax_error(replaced(kHeader, "BRDF", "BSDF")), HasSubstr("ScatterType BRDF or BTDF"));
  EXPECT_THAT(zemax_error(replaced(kHeader, "Symmetry\tPlaneSymmetrical\n", "")),
              HasSubstr("keyword symmetry"));
  EXPECT_THAT(zemax_error(replaced(kHeader, "ScatterRadial", "Scatter")), HasSubstr("keyword of the header"));
  EXPECT_THAT(zemax_error(replaced(kHeader, "10 30", "30 10")), HasSubstr("increasing"));
  EXPECT_THAT(zemax_error(replaced(kHeader, "10 30", "10 95")), HasSubstr("[0, 90]"));
  EXPECT_THAT(zemax_error(replaced(kHeader, "10 30", "10 30 50")), HasSubstr("end of the line"));
  EXPECT_THAT(zemax_error(replaced(kHeader, "SampleRotation\t1\n", "SampleRotation\t999999999\n")),
              HasSubstr("[1, 4096]"));
  EXPECT_THAT(zemax_error(kHeader), HasSubstr("12 values"));
  EXPECT_THAT(zemax_error(kHeader + replaced(kData, "1 3\n", "1\n")), HasSubstr("finite number for a value"));
  EXPECT_THAT(zemax_error(kHeader + replaced(kData, "1 3\n", "1 3 4\n")), HasSubstr("end of the line"));
  EXPECT_THAT(zemax_error(kHeader + replaced(kData, "1 3\n", "1 inf\n")), HasSubstr("finite"));
  EXPECT_THAT(zemax_error(kHeader + replaced(kData, "1 3\n", "1 1e200\n")), HasSubstr("below 1e38"));
  EXPECT_THAT(zemax_error(kHeader + replaced(kData, "TIS 0.2\n", "")), HasSubstr("tis"));
  EXPECT_THAT(zemax_error(kHeader + replaced(kData, "DataEnd\n", "")), HasSubstr("dataend"));
}

TEST(Zemax, ReadsABlackCoatingMeasuredTo80Degrees) {
  BURNISH_NEEDS_DATA();
  const auto file = parse_zemax(read_file(data_folder() / "zemax" / "AnoBlackEC1onAlum.bsdf"));
  EXPECT_EQ(file.findings.sample_count, 4u * 19 * 12);
  EXPECT_EQ(file.findings.negative_count, 0u);
  EXPECT_TRUE(file.table.isotropic());
  // The instrument stops 80 degrees from the normal. Exactly the entries beyond are holes if the frame is
  // right.
  const auto& axes = file.table.axes;
  std::size_t entry = 0;
  for (const double theta_i : axes[1].nodes)
    for (const double azimuth : axes[2].nodes)
      for (const double radial : axes[3].nodes) {
        const double theta = degrees(theta_of(around_specular(theta_i, 0, azimuth, radial)));
        if (std::abs(theta - 80) > 0.01) {
          EXPECT_EQ(std::isnan(file.table.values[entry]), theta > 80) << entry;
        }
        ++entry;
      }
  // At grazing incidence the lobe leans to the horizon, so azimuth 180 is brighter than azimuth 0.
  double to_horizon, to_normal;
  const Vec3 wi = spherical_direction(radians(70), 0);
  ASSERT_TRUE(file.table.eval(wi, spherical_direction(radians(78), kPi), {&to_horizon, 1}));
  ASSERT_TRUE(file.table.eval(wi, spherical_direction(radians(62), kPi), {&to_normal, 1}));
  EXPECT_GT(to_horizon, 1.5 * to_normal);
}

TEST(Zemax, ReadsAnAnisotropicSensor) {
  BURNISH_NEEDS_DATA();
  const auto file = parse_zemax(read_file(data_folder() / "zemax" / "IMX455.bsdf"));
  EXPECT_EQ(file.findings.sample_count, 37u * 4 * 37 * 21);
  EXPECT_FALSE(file.table.isotropic());
  // The file repeats the half turn, except around its rotations of 0, which it flips.
  double f, turned;
  const Vec3 wi = spherical_direction(radians(30), radians(115)),
             wo = spherical_direction(radians(35), radians(-60));
  ASSERT_TRUE(file.table.eval(wi, wo, {&f, 1}));
  ASSERT_TRUE(file.table.eval(mirror(wi), mirror(wo), {&turned, 1}));
  EXPECT_NEAR(f, turned, 1e-6 * f);
}

}  // namespace
}  // namespace burnish
