// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/lighttools.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string with(std::string text, std::string_view what, std::string_view other) {
  return text.replace(text.find(what), what.size(), other);
}

LightToolsFile read(const std::string& text, const OpenOptions& options = {}) {
  return parse_lighttools(memory_file(text), options);
}

double at(const AngleTable& table, double theta_i_deg, double theta_o_deg, double azimuth_deg) {
  double f = 0;
  EXPECT_TRUE(table.eval_raw(spherical_direction(radians(theta_i_deg), 0.4),
                             spherical_direction(radians(theta_o_deg), 0.4 + radians(azimuth_deg)),
                             std::span(&f, 1)));
  return f;
}

TEST(LightTools, PutsTheLightAtNinetyDegrees) {
  const LightToolsFile file = read(seeds::kLightTools);
  EXPECT_TRUE(file.table.folded);
  EXPECT_TRUE(file.table.isotropic());
  // The file's azimuth 270 is the mirror direction, 180 degrees from the light. 90 is the light's own side.
  EXPECT_NEAR(at(file.table, 30, 60, 180), 0.5, 1e-6);
  EXPECT_NEAR(at(file.table, 30, 60, 0), 0.2, 1e-6);
  EXPECT_NEAR(at(file.table, 30, 60, 90), -0.3, 1e-6);
  EXPECT_NEAR(at(file.table, 30, 60, -90), -0.3, 1e-6);
  EXPECT_NEAR(at(file.table, 30, 30, 135), (-0.1 + 0.3) / 2, 1e-6);
}

TEST(LightTools, HasSidesAndTransmission) {
  const LightToolsFile file = read(seeds::kLightTools);
  EXPECT_THAT(file.findings.left_out, ElementsAre("transmission-back"));
  const LightToolsFile back = read(seeds::kLightTools, {.part = BsdfPart::transmission_back});
  EXPECT_TRUE(back.findings.transmits());
  EXPECT_NEAR(at(back.table, 0, 0, 0), 0.2, 1e-6);  // an AOI of 180 is the normal
}

TEST(LightTools, TakesTheWholeCircleAndColours) {
  std::string text =
      "Symmetry Asymmetric\nSpectralContent XYZ\nScatterAzimuth 5\n0 90 180 270 360\nScatterRadial 1\n0\n"
      "DataBegin\n";
  for (const char* name : {"TrisZ", "TrisX", "TrisY"})
    text += std::string("AOI 0\nSide Front\nScatterType BRDF\nTristimulusValue ") + name +
            "\nTIS 1\n1.089 1.089 1.089 1.089 1.089\n";
  const LightToolsFile file = read(text + "DataEnd\n");
  EXPECT_FALSE(file.table.folded);
  EXPECT_EQ(file.table.axes[3].nodes.size(), 4u);
  EXPECT_EQ(file.table.channels(), 3u);
}

TEST(LightTools, TellsWavelengthsApart) {
  std::string text = seeds::kLightTools;
  text.insert(text.find("DataEnd"),
              "AOI 0\nPOI 0\nSide Front\nWavelength 650\nScatterType BRDF\nTIS 0.3\n7 7 7 7 7 7\n");
  EXPECT_NEAR(at(read(text).table, 0, 0, 0), 0.1, 1e-6);
  EXPECT_NEAR(at(read(text, {.band = "650 nm"}).table, 0, 0, 0), 7, 1e-6);
}

TEST(LightTools, ScalesToTotals) {
  const LightToolsFile file = read(seeds::kLightTools, {.scale_to_tis = true});
  EXPECT_THAT(file.findings.conventions, ::testing::Contains(HasSubstr("scaled to TIS")));
}

TEST(LightTools, IsToldFromZemax) {
  const std::string text = "Source Measured\n" + seeds::kLightTools;
  EXPECT_EQ(parse_source(memory_file(text), {}).findings.format, "LightTools BSDF");
  EXPECT_FALSE(looks_like_lighttools(seeds::kZemax));
}

TEST(LightTools, SaysWhatIsWrong) {
  const auto error = [](const std::string& text) { return error_of([&] { read(text); }); };
  EXPECT_THAT(error(with(seeds::kLightTools, "Monochrome", "Spectral")), HasSubstr("'Spectral'"));
  EXPECT_THAT(error(with(seeds::kLightTools, "90 180 270", "90 80 270")), HasSubstr("increasing"));
  EXPECT_THAT(error(with(seeds::kLightTools, "AOI 30\nPOI 0", "AOI 30\nPOI 9")), HasSubstr("one plane"));
  EXPECT_THAT(error(with(seeds::kLightTools, "AOI 30", "AOI 0")), HasSubstr("two at 0 degrees"));
  EXPECT_THAT(error(with(seeds::kLightTools, "AOI 30", "AOI 130")), HasSubstr("or 180"));
  EXPECT_THAT(error(with(seeds::kLightTools, "DataEnd", "")), HasSubstr("the end of the file"));
  EXPECT_THAT(error(with(seeds::kLightTools, "Side Back", "Side Top")), HasSubstr("Side Front or Back"));
}

}  // namespace
}  // namespace burnish
