// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/integra.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/albedo.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;

/// Returns a grey file of one value at every angle.
std::string even(const std::string& data, const std::string& value, const std::string& kbdf = "") {
  std::string text = ";; even\nTypeSym ASymmetrical\nTypeColorModel BW\nTypeData " + data +
                     "\nsigma 2\n0 60\nphi 3\n0 180 360\ntheta 3\n0 90 180\nbw\n";
  if (!kbdf.empty()) text += " kbdf " + kbdf + "\n";
  text += " def\n";
  for (int k = 0; k < 18; ++k) text += " " + value + (k % 5 == 0 ? " ;; remark\n" : "");
  return text + "\n enddef\n";
}

std::array<double, 3> colours_at(const AngleTable& table, Vec3 wi, Vec3 wo) {
  std::array<double, 3> f{};
  EXPECT_TRUE(table.eval_raw(wi, wo, f));
  return f;
}

TEST(Integra, DividesByPiAndMultipliesByKbdf) {
  const IntegraFile file = parse_integra(memory_file(even("Luminance Absolute", "0.5", "1 0.5")), {});
  EXPECT_EQ(file.findings.format, "Integra DDR");
  EXPECT_NEAR(directional_albedo(file.table, {0, 0, 1}).albedo[0], 0.5, 1e-3);
  EXPECT_NEAR(directional_albedo(file.table, spherical_direction(radians(60), 1)).albedo[0], 0.25, 1e-3);
  EXPECT_EQ(file.table.axes[2].nodes.size(), 2u);  // 360 is 0 again
}

TEST(Integra, DividesIntensityByTheCosine) {
  const IntegraFile file = parse_integra(memory_file(even("Intensity Absolute", "0.5")), {});
  double f = 0;
  ASSERT_TRUE(file.table.eval_raw({0, 0, 1}, {0, 0, 1}, std::span(&f, 1)));
  EXPECT_NEAR(f, 0.5, 1e-6);
  const Vec3 wi = spherical_direction(radians(60), 0);
  ASSERT_TRUE(file.table.eval_raw(wi, mirror(wi), std::span(&f, 1)));
  EXPECT_NEAR(f, 1, 1e-6);
}

TEST(Integra, ScalesRelativeValues) {
  const IntegraFile file = parse_integra(memory_file(even("Luminance Relative", "7", "0.3 0.2")), {});
  EXPECT_NEAR(directional_albedo(file.table, {0, 0, 1}).albedo[0], 0.3, 3e-3);
  EXPECT_NEAR(directional_albedo(file.table, spherical_direction(radians(60), 1)).albedo[0], 0.2, 2e-3);
}

TEST(Integra, RefractsAtSigmat) {
  const IntegraFile file = parse_integra(memory_file(seeds::kIntegra), {});
  EXPECT_EQ(file.findings.format, "Integra DDT");
  EXPECT_TRUE(file.findings.transmits());
  // The peak of light from 45 degrees leaves at 28 degrees, in the mirrored direction.
  const Vec3 wi = spherical_direction(radians(45), 1), peak = spherical_direction(radians(28), 1 + kPi);
  EXPECT_NEAR(colours_at(file.table, wi, peak)[0], 0.5 * 6 / kPi, 1e-6);
  // Ten degrees towards the normal is phi = 0, away from it phi = 180.
  EXPECT_NEAR(colours_at(file.table, wi, spherical_direction(radians(18), 1 + kPi))[0], 1 / kPi, 1e-6);
  EXPECT_NEAR(colours_at(file.table, wi, spherical_direction(radians(38), 1 + kPi))[0], 0.5 / kPi, 1e-6);
  EXPECT_NEAR(colours_at(file.table, wi, peak)[2], 2 / kPi, 1e-6);
}

TEST(Integra, IsTransmissionByItsName) {
  FileBytes file = memory_file(even("Luminance Absolute", "1"));
  file.name = "glass.DDT";
  EXPECT_TRUE(parse_integra(file, {}).findings.transmits());
}

TEST(Integra, ReadsSpectra) {
  const std::string text =
      "TypeSym AxiSymmetrical\nTypeColorModel spectral 2\nTypeData Luminance Absolute\nsigma 1 0\nphi 1 0\n"
      "theta 2 0 90\nwl 500\ndef 1 1\nenddef\nwl 600\ndef 2 2\nenddef\n";
  const IntegraFile file = parse_integra(memory_file(text), {.keep_spectral = true});
  EXPECT_EQ(file.findings.lambda_nm, (std::vector<double>{500, 600}));
  EXPECT_EQ(file.table.channels(), 2u);
  EXPECT_EQ(parse_integra(memory_file(text), {}).table.channels(), 3u);
}

TEST(Integra, SaysWhatIsWrong) {
  const auto error = [](std::string_view what, std::string_view other) {
    std::string text = seeds::kIntegra;
    text.replace(text.find(what), what.size(), other);
    return error_of([&] { parse_integra(memory_file(text), {}); });
  };
  EXPECT_THAT(error("PlaneSymmetrical", "DirSymmetrical"), HasSubstr("'dirsymmetrical'"));
  EXPECT_THAT(error("phi 2\n 0 180", "phi 2\n 0 200"), HasSubstr("phi in [0, 180]"));
  EXPECT_THAT(error("theta 3\n 0 10 90", "theta 3\n 0 10 9"), HasSubstr("increasing theta"));
  EXPECT_THAT(error("theta 3", "theta 3000"), HasSubstr("theta"));
  EXPECT_THAT(error("gre\n", "red\n"), HasSubstr("'red' again"));
  EXPECT_THAT(error("blue\n def\n 2", "blue\n def\n x"), HasSubstr("a finite number for a value"));
  EXPECT_THAT(error("TypeData Luminance Absolute\n", ""), HasSubstr("the keyword TypeData"));
}

}  // namespace
}  // namespace burnish
