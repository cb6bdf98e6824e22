// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/open_source.h>
#include <burnish/io/ssdd.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Source opened(const std::string& text, const OpenOptions& options = {}) {
  return parse_source(memory_file(text), options);
}

std::vector<double> values_at(const Source& source, Vec3 wi, Vec3 wo) {
  std::vector<double> f(source.ref().channels());
  EXPECT_TRUE(source.ref().eval(wi, wo, f));
  return f;
}

/// Returns a grey file whose values are 1, 2, 3, ...
std::string counted_file(const std::string& system, const std::string& lists, int count,
                         const std::string& reduction = "") {
  std::string text = "VERSION 0.3\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\nPARAM_TYPE " + system +
                     "_coordinate_system\n" + reduction + lists + "DATA ascii\n";
  for (int k = 1; k <= count; ++k) text += fmt::format("{}\n", k);
  return text;
}

TEST(Ssdd, ReadsTheSmallestFile) {
  const Source source = opened(
      "VERSION 0.2\n\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\nPARAM_TYPE spherical_coordinate_system\n"
      "PARAM0_LIST 0\nPARAM2_LIST 0\nPARAM3_LIST 0\nDATA ascii\n0.3183\n");
  EXPECT_TRUE(source.ref().isotropic());
  EXPECT_NEAR(values_at(source, spherical_direction(1, 2), spherical_direction(0.3, 0))[0], 0.3183, 1e-6);
}

TEST(Ssdd, CountsTheFirstParameterFastest) {
  const Source source =
      opened(counted_file("spherical", "PARAM0_LIST 0 60\nPARAM2_LIST 0 30 60\nPARAM3_LIST 0 180 360\n", 18));
  // Value 1 + p0 + 2 p2 + 6 p3.
  const Vec3 wi = spherical_direction(radians(60), 0.3);
  EXPECT_NEAR(values_at(source, wi, spherical_direction(radians(30), 0.3))[0], 1 + 1 + 2, 1e-6);
  EXPECT_NEAR(values_at(source, wi, spherical_direction(radians(60), 0.3 + kPi))[0], 1 + 1 + 4 + 6, 1e-6);
}

TEST(Ssdd, CountsAzimuthsOfAnisotropicDataFromTheTangent) {
  const Source source = opened(counted_file(
      "spherical",
      "PARAM0_LIST 0 60\nPARAM1_LIST 0 90 180 270 360\nPARAM2_LIST 0 60\nPARAM3_LIST 0 180 360\n", 60));
  EXPECT_FALSE(source.ref().isotropic());
  // Value 1 + p0 + 2 p1 + 10 p2 + 20 p3; azimuths of wo do not count from wi.
  EXPECT_NEAR(values_at(source, spherical_direction(radians(60), radians(90)),
                        spherical_direction(radians(60), kPi))[0],
              1 + 1 + 2 + 10 + 20, 1e-6);
}

TEST(Ssdd, HasHalfAndDifferenceAngles) {
  const Source source = opened(seeds::kSsdd, {.keep_spectral = true});
  EXPECT_EQ(source.findings.lambda_nm, (std::vector<double>{450, 550, 650}));
  EXPECT_EQ(source.findings.description, "seed");
  const auto [wi, wo] = from_half_diff({radians(45), 0.3, radians(30), 0});
  // Halfway between 3 and .3.
  EXPECT_NEAR(values_at(source, wi, wo)[2], 1.65, 1e-6);
  EXPECT_NEAR(values_at(source, wo, wi)[0], values_at(source, wi, wo)[0], 1e-12);
  ASSERT_EQ(source.findings.direct.size(), 2u);
  EXPECT_NEAR(source.findings.direct[1].share, 0.5, 1e-7);
  EXPECT_THAT(source.findings.left_out, ElementsAre("specular reflectance"));
}

TEST(Ssdd, ReadsBinaryValuesAndOffsets) {
  const Source source = opened(seeds::binary_ssdd_seed());
  EXPECT_TRUE(source.findings.transmits());
  const auto* table = std::get_if<AngleTable>(&source.brdf);
  ASSERT_NE(table, nullptr);
  EXPECT_EQ(table->channels(), 3u);
  EXPECT_THAT(table->centre_theta, ElementsAre(0, ::testing::DoubleNear(radians(28), 1e-12)));
  EXPECT_EQ(table->axes[2].nodes.size(), 2u);
  const std::string cut = seeds::binary_ssdd_seed();
  EXPECT_THAT(error_of([&] { opened(cut.substr(0, cut.size() - 1)); }),
              HasSubstr("216 bytes of binary values"));
}

TEST(Ssdd, HasTheMirrorDirectionAtTheCentre) {
  const Vec3 wi = spherical_direction(radians(60), 0.3);
  for (const std::string system : {"specular", "distorted_spherical"}) {
    // Value 1 + p0 + 2 p2 at every azimuth.
    const Source source =
        opened(counted_file(system, "PARAM0_LIST 0 60\nPARAM2_LIST 0 90\nPARAM3_LIST 0\n", 4));
    EXPECT_NEAR(values_at(source, wi, mirror(wi))[0], 2, 1e-6) << system;
  }
  // Value 1 + p0 + 2 p2 + 4 p3. Half the way to phi = 0 is on the normal's side.
  const Source source = opened(
      counted_file("specular", "PARAM0_LIST 0 60\nPARAM2_LIST 0 90\nPARAM3_LIST 0 90 180 270 360\n", 20));
  EXPECT_NEAR(values_at(source, wi, spherical_direction(radians(15), 0.3 + kPi))[0], 2 + 1, 1e-6);
}

TEST(Ssdd, ReachesTheBorderOfDistortedCoordinates) {
  const Source source =
      opened(counted_file("distorted_spherical", "PARAM0_LIST 0 60\nPARAM2_LIST 0 90\nPARAM3_LIST 0\n", 4));
  // One azimuth: the value depends on the distorted polar angle alone, which is 90 degrees on the horizon.
  const Vec3 wi = spherical_direction(radians(60), 0);
  for (const double phi : {0.0, 1.0, 2.0, 3.0})
    EXPECT_NEAR(values_at(source, wi, spherical_direction(radians(89.9999), phi))[0], 4, 1e-4);
}

TEST(Ssdd, SaysWhatIsWrong) {
  const auto error = [](std::string_view what, std::string_view other) {
    std::string text = seeds::kSsdd;
    text.replace(text.find(what), what.size(), other);
    return error_of([&] { opened(text); });
  };
  EXPECT_THAT(error("brdf", "bssrdf"), HasSubstr("'bssrdf'"));
  EXPECT_THAT(error("WAVELENGTH_LIST 450 550 650\n", ""), HasSubstr("the entry WAVELENGTH_LIST"));
  EXPECT_THAT(error("WAVELENGTH_LIST 450 550", "WAVELENGTH_LIST 450 350"),
              HasSubstr("increasing wavelengths"));
  EXPECT_THAT(error("PARAM3_LIST 0 90", "PARAM3_LIST 0 180"), HasSubstr("PARAM3_LIST in [0, 90]"));
  EXPECT_THAT(error("half_difference", "spherical"), HasSubstr("reciprocity with half_difference"));
  EXPECT_THAT(error("PARAM0_LIST 0 90", "PARAM0_LIST 0 0"), HasSubstr("rising numbers"));
  EXPECT_THAT(error("1 2 3\n.1", "1 2\n.1"), HasSubstr("a line of 3 values up to 1e+30"));
  EXPECT_THAT(error("1 2 3\n.1", "1 2 3 4\n.1"), HasSubstr("'4' behind them"));
  EXPECT_THAT(error("DATA_TYPE specular_reflectance", "DATA_TYPE brdf"), HasSubstr("PARAM_TYPE"));
}

}  // namespace
}  // namespace burnish
