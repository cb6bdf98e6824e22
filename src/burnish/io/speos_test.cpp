// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/speos.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

double value(const AngleTable& table, Vec3 wi, Vec3 wo, std::size_t channel = 0) {
  std::vector<double> f(table.channels());
  EXPECT_TRUE(table.eval_raw(wi, wo, f));
  return f[channel];
}

// Returns a white Lambertian surface's intensities at two wavelengths.
std::string brdf_text(double reflectance) {
  std::string text =
      "OPTIS - brdf surface file v9.0\n0\nScattering surface\n0\n\n1\t0\n1\n2\t2\n0\t60\n450\t650\n";
  for (int block = 0; block < 4; ++block) {
    text += std::to_string(100 * reflectance) + "\n91 3\n\t0\t180\t360\n";
    for (int theta = 0; theta <= 90; ++theta) text += std::to_string(theta) + "\t0.25\t0.25\t0.25\n";
  }
  return text;
}

TEST(Speos, TurnsRotationsAndAzimuthsIntoOurs) {
  EXPECT_TRUE(looks_like_speos(seeds::kSpeos));
  const SpeosFile file = parse_speos(memory_file(seeds::kSpeos), {.keep_spectral = true});
  const AngleTable& table = file.table;
  EXPECT_FALSE(table.isotropic());
  EXPECT_EQ(table.channels(), 2);
  EXPECT_EQ(file.findings.lambda_nm, (std::vector<double>{450, 650}));
  EXPECT_EQ(file.findings.description, "seed");
  EXPECT_EQ(file.findings.negative_count, 2u);
  // Light travels to +x at rotation 0, so phi = 120 degrees is 120 degrees from +x.
  const Vec3 wi = spherical_direction(radians(30), kPi);
  const double at_120 = value(table, wi, spherical_direction(radians(60), radians(120)));
  const double at_240 = value(table, wi, spherical_direction(radians(60), radians(240)));
  EXPECT_NEAR(at_120 / at_240, 0.5 / 0.6, 1e-6);
  // Twice the reflectance gives twice the value, and the cosine is divided out.
  EXPECT_NEAR(value(table, wi, spherical_direction(radians(60), 0), 1),
              2 * value(table, wi, spherical_direction(radians(60), 0)), 1e-6);
  EXPECT_NEAR(value(table, wi, {0, 0, 1}) / at_120, 1 / (0.5 / std::cos(radians(60))), 1e-6);
  // Rotated by 90 degrees, light travels to -y.
  const Vec3 turned = spherical_direction(radians(30), kPi / 2);
  EXPECT_LT(value(table, turned, spherical_direction(radians(60), radians(30))), 0);
  EXPECT_THAT(parse_speos(memory_file(seeds::kSpeos), {}).findings.illuminant, "equal energy");
}

TEST(Speos, ScalesABrdfToItsReflectanceUnlessItHasIt) {
  const double reflectance = 0.25 * kPi;
  const Vec3 wi = spherical_direction(0.3, 0), wo = spherical_direction(0.5, 1);
  const SpeosFile kept = parse_speos(memory_file(brdf_text(reflectance)), {.keep_spectral = true});
  EXPECT_TRUE(kept.table.isotropic());
  EXPECT_NEAR(value(kept.table, wi, wo), 0.25, 1e-7);
  const SpeosFile scaled = parse_speos(memory_file(brdf_text(reflectance / 2)), {.keep_spectral = true});
  EXPECT_NEAR(value(scaled.table, wi, wo), 0.125, 1e-4);  // tolerance of the quadrature
  EXPECT_EQ(parse_speos(memory_file(brdf_text(reflectance)), {}).table.channels(), 3);
}

// The table has four polar angles of a constant. A sum of trapezoids has 18.2 %, which is no reason to scale.
TEST(Speos, KeepsCoarseTablesThatAgreeWithTheirReflectance) {
  const auto text = [](const char* modes, const char* type, const char* rows) {
    std::string made = fmt::format(
        "OPTIS - brdf surface file v8.0\n0\ncomment\n5\n-----\n{}\n{}\n2\t1\n0 60\n550\n", modes, type);
    for (const char* reflectance : {"20", "20"})
      made += fmt::format("{}\n4\t4\n\t0\t120\t240\t360\n{}", reflectance, rows);
    return made;
  };
  const char* const f =
      "0\t0.063662\t0.063662\t0.063662\t0.063662\n30\t0.063662\t0.063662\t0.063662\t0.063662\n"
      "60\t0.063662\t0.063662\t0.063662\t0.063662\n90\t0.063662\t0.063662\t0.063662\t0.063662\n";
  const SpeosFile file = parse_speos(memory_file(text("1\t0", "1", f)), {});
  EXPECT_THAT(file.findings.conventions, Contains(HasSubstr("taken as they are")));
  EXPECT_NEAR(value(file.table, spherical_direction(0.3, 0), spherical_direction(0.5, 1)), 0.063662, 1e-7);
  // Transmission behind the reflection changes nothing, but the findings name it.
  const std::string both =
      text("1\t1", "1", f) + text("", "", f).substr(text("", "", "").find("\n550\n") + 5);
  const SpeosFile reflection = parse_speos(memory_file(both), {});
  EXPECT_EQ(reflection.table.values, file.table.values);
  EXPECT_THAT(reflection.findings.left_out, ElementsAre("transmission"));
  EXPECT_TRUE(file.findings.left_out.empty());
}

TEST(Speos, KeepsDarkSpectraAndSpectraThatVaryLittle) {
  // The stated share at 650 nm is 12 times that at 450 nm, or 2 % more. The values keep this ratio.
  for (const auto& [blue, red] : {std::pair("0.04", "0.48"), std::pair("50", "51")}) {
    std::string text = seeds::kSpeos;
    text.replace(text.find("450\t20"), 6, std::string("450\t") + blue);
    text.replace(text.find("650\t40"), 6, std::string("650\t") + red);
    const SpeosFile file = parse_speos(memory_file(text), {.keep_spectral = true});
    ASSERT_EQ(file.findings.lambda_nm, (std::vector<double>{450, 650}));
    const Vec3 wi = spherical_direction(radians(30), kPi);
    EXPECT_NEAR(value(file.table, wi, {0, 0, 1}, 1) / value(file.table, wi, {0, 0, 1}, 0),
                std::stod(red) / std::stod(blue), 1e-5 * std::stod(red) / std::stod(blue));
  }
}

TEST(Speos, KeepsASingleWavelength) {
  std::string anisotropic = seeds::kSpeos, brdf = brdf_text(0.5);
  anisotropic.replace(anisotropic.find("2\n450\t20\n650\t40"), 15, "1\n905\t20");
  constexpr std::string_view kTwo = "2\t2\n0\t60\n450\t650";
  brdf.replace(brdf.find(kTwo), kTwo.size(), "2\t1\n0\t60\n905");
  for (const bool spectral : {false, true})
    for (const std::string& text : {anisotropic, brdf}) {
      // Two further blocks of a .brdf follow the block that is read.
      const SpeosFile file = parse_speos(memory_file(text), {.keep_spectral = spectral});
      EXPECT_EQ(file.table.channels(), 1);
      EXPECT_EQ(file.findings.lambda_nm, std::vector<double>{905});
    }
}

// Each part has one incidence, one wavelength, two thetas and two phis. Thetas of transmission count from 90 to 180.
TEST(Speos, ReadsTransmissionOfABrdfMirroredThroughTheSurface) {
  const std::string text =
      "OPTIS - brdf surface file v8.0\n0\ncomment\n2\n-\n1\t1\n1\n1\t1\n30\n550\n"
      "31.415927\n2\t2\n0\t180\n0\t0.1\t0.1\n90\t0.1\t0.1\n"
      "20\n3\t2\n0\t180\n90\t0\t0\n150\t0.3\t0.1\n180\t0.2\t0.2\n";
  const SpeosFile reflection = parse_speos(memory_file(text), {});
  EXPECT_EQ(reflection.findings.left_out, std::vector<std::string>{"transmission"});
  EXPECT_NEAR(value(reflection.table, {0, 0, 1}, {0, 0, 1}), 0.1, 1e-6);
  const SpeosFile through = parse_speos(memory_file(text), {.part = BsdfPart::transmission_front});
  EXPECT_EQ(through.findings.left_out, std::vector<std::string>{"reflection"});
  EXPECT_TRUE(through.findings.transmits());
  // Straight on, at theta 150 and phi 0, the value is three times as bright as at phi 180.
  const Vec3 wi = spherical_direction(radians(30), kPi);
  const double straight = value(through.table, wi, mirror(wi)), aside = value(through.table, wi, wi);
  EXPECT_GT(aside, 0);
  EXPECT_NEAR(straight / aside, 3, 1e-5);
  EXPECT_THAT(error_of([&] { parse_speos(memory_file(text), {.part = BsdfPart::reflection_back}); }),
              HasSubstr("expected part reflection-back, found reflection-front, transmission-front"));
}

// Angles of both parts come first, then spectra of both, then blocks of both.
TEST(Speos, ReadsBothPartsOfAnAnisotropicFile) {
  const std::string text =
      "OPTIS - Anisotropic BSDF surface file v8.0\n0\ncomment\n2\n-\n0\t1\t0\n1\t1\n1\n"
      "1\n0\n1\n10\n1\n0\n2\n20\t40\n"
      "10\t0\nreflection\n1\n550\t62.831853\n20\t0\ntransmission\n1\n550\t15.707963\n"
      "2 2\n0\t360\n0\t0.2\t0.2\n90\t0.2\t0.2\n"
      "2 2\n0\t360\n90\t0.05\t0.05\n180\t0.05\t0.05\n"
      "2 2\n0\t360\n90\t0.07\t0.07\n180\t0.07\t0.07\n";
  const SpeosFile reflection = parse_speos(memory_file(text), {}),
                  through = parse_speos(memory_file(text), {.part = BsdfPart::transmission_front});
  EXPECT_NEAR(value(reflection.table, {0, 0, 1}, {0, 0, 1}), 0.2, 1e-5);
  EXPECT_EQ(through.table.axes[1].nodes.size(), 2u);
  EXPECT_NEAR(value(through.table, spherical_direction(radians(20), 1), {0, 0, 1}), 0.05, 1e-5);
  EXPECT_NEAR(value(through.table, spherical_direction(radians(40), 1), {0, 0, 1}), 0.07, 1e-5);
}

TEST(Speos, SaysWhatIsWrong) {
  const auto error = [](std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return error_of([&] { parse_speos(memory_file(text), {}); });
  };
  EXPECT_THAT(error(seeds::kSpeos, "v8.0\n0", "v8.0\n1"), HasSubstr("text mode, 0"));
  EXPECT_THAT(error(seeds::kSpeos, "1\t0\n0\n", "0\t0\n0\n"), HasSubstr("1 0, 0 1 or 1 1, found 0 0"));
  EXPECT_THAT(error(brdf_text(0.5), "1\t0\n1\n", "1\t1\n1\n"), HasSubstr("a number for a transmittance"));
  EXPECT_THAT(error(seeds::kSpeos, "0 90\n", "90 0\n"), HasSubstr("increasing anisotropy angles"));
  EXPECT_THAT(error(seeds::kSpeos, "30\n1\n30\n", "30\n1\n31\n"), HasSubstr("the same incidences"));
  EXPECT_THAT(error(seeds::kSpeos, "2 3\n", "4000 4000\n"), HasSubstr("4000 x 4000 values"));
  EXPECT_THAT(error(seeds::kSpeos, "0.4\t0.5", "0.4\tx"), HasSubstr("a finite number for a value"));
  EXPECT_THAT(error(seeds::kSpeos, "60\t0.4", "91\t0.4"), HasSubstr("theta in [0, 90]"));
  EXPECT_THAT(error(seeds::kSpeos, "450\t20", "450\t1e80"),
              HasSubstr("reflectances that keep values below 1e+30"));
}

// In this file, blocks begin with a line of two counts, values contain the cosine, and phi = 0 is the mirror direction.
TEST(Speos, ReadsASurfaceAsAFewLinesDo) {
  BURNISH_NEEDS_DATA();
  const FileBytes bytes = read_file(data_folder() / "speos" / "aniso_bsdf.anisotropicbsdf");
  const SpeosFile file = parse_speos(bytes, {});
  EXPECT_TRUE(file.table.isotropic());
  EXPECT_THAT(file.findings.conventions, Contains(HasSubstr("taken as they are")));
  const std::vector<double> incidences{5,  10, 15, 20, 25, 30, 35, 40, 45, 50,
                                       55, 60, 65, 70, 75, 80, 85, 88, 89};
  std::istringstream lines{std::string(bytes.text())};
  std::size_t block = 0, compared = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line != "21 41") continue;
    std::getline(lines, line);
    std::istringstream header(line);
    const std::vector<double> phis(std::istream_iterator<double>(header), {});
    const Vec3 wi = spherical_direction(radians(incidences[block++ % 19]), kPi);
    for (int row = 0; row < 21; ++row) {
      std::getline(lines, line);
      std::istringstream numbers(line);
      double theta, stored;
      numbers >> theta;
      for (const double phi : phis) {
        numbers >> stored;
        if (theta > 89.5) continue;
        const double f = stored / std::cos(radians(theta));
        EXPECT_NEAR(value(file.table, wi, spherical_direction(radians(theta), radians(phi))), f, 1e-5 * f);
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 57u * 20 * 41);
}

}  // namespace
}  // namespace burnish
