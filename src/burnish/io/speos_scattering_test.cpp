// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/speos_scattering.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/albedo.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kHead = "OPTIS - Simple scattering surface file v2.0\n";

SpeosScatteringFile parsed(const std::string& body, const OpenOptions& options = {}) {
  return parse_speos_scattering(memory_file(kHead + body), options);
}

double value_of(const SpeosScatteringFile& file, Vec3 wi, Vec3 wo) {
  double f = 0;
  EXPECT_TRUE(file.brdf.eval(wi, wo, std::span(&f, 1)));
  return f;
}

TEST(SpeosScattering, IsLambertianAfterAbsorption) {
  const SpeosScatteringFile file = parsed("white\nReflection\n20 50 0 5\n");
  EXPECT_EQ(file.findings.description, "white");
  EXPECT_NEAR(value_of(file, spherical_direction(1, 2), spherical_direction(0.3, 1)), 0.4 / kPi, 1e-15);
  ASSERT_EQ(file.findings.direct.size(), 2u);
  EXPECT_NEAR(file.findings.direct[0].share, 0.4, 1e-15);
  EXPECT_THAT(file.findings.left_out, ElementsAre("the specular share of 40 %"));
}

TEST(SpeosScattering, HasTheGaussianThatSpeosTabulates) {
  // A public table of a Gaussian of 10 degrees, made by Speos with a reflectance of 4 %, has these values of
  // f cos(theta_o) at 0, 1, 2 and 3 degrees. Its total is within .3 % of the reflectance.
  const SpeosScatteringFile file = parsed("gloss\nReflection\n96 0 100 10\n");
  const double at_peak = 1.16326, peak = value_of(file, {0, 0, 1}, {0, 0, 1});
  EXPECT_NEAR(peak, at_peak, 3e-3 * at_peak);
  int degree = 0;
  for (const double stored : {1.16326, 1.13145, 1.04114, 0.906368}) {
    const Vec3 wo = spherical_direction(radians(degree++), 0.7);
    EXPECT_NEAR(value_of(file, {0, 0, 1}, wo) * wo.z / peak, stored / at_peak, 1e-5);
  }
  // Off the normal the angle is that from the mirror direction.
  const Vec3 wi = spherical_direction(radians(50), 0.2), wo = spherical_direction(radians(55), 0.2 + kPi);
  EXPECT_NEAR(value_of(file, wi, wo) * wo.z, peak * std::pow(0.5, 1), 1e-12);
  EXPECT_NEAR(directional_albedo(file.brdf, spherical_direction(0.5, 0)).albedo[0], 0.04, 2e-4);
}

TEST(SpeosScattering, SharesBothSides) {
  const auto share = [](const SpeosScatteringFile& file) {
    return directional_albedo(file.brdf, spherical_direction(0.3, 0)).albedo[0];
  };
  const SpeosScatteringFile front = parse_speos_scattering(memory_file(seeds::kSpeosScattering), {});
  EXPECT_NEAR(share(front), 0.9 * 0.6 * 0.5, 2e-3);
  EXPECT_NEAR(front.findings.direct[0].share, 0.9 * 0.6 * 0.5, 1e-15);
  const SpeosScatteringFile through =
      parse_speos_scattering(memory_file(seeds::kSpeosScattering), {.part = BsdfPart::transmission_front});
  EXPECT_NEAR(share(through), 0.9 * 0.4 * 0.9, 2e-3);
  EXPECT_TRUE(through.findings.transmits());
}

TEST(SpeosScattering, SaysWhatIsWrong) {
  const auto error = [](const std::string& body) { return error_of([&] { parsed(body); }); };
  EXPECT_THAT(error("x\nDiffuse\n0 100 0 0\n"), HasSubstr("Reflection, Transmission or Both"));
  EXPECT_THAT(error("x\nReflection\n0 60 60 5\n"), HasSubstr("120 %"));
  EXPECT_THAT(error("x\nReflection\n0 60 40 0\n"), HasSubstr("a width in [0.001, 360] degrees"));
  EXPECT_THAT(error("x\nReflection\n101 0 0 0\n"), HasSubstr("absorption in [0, 100] %"));
  EXPECT_THAT(error("x\nBoth\n\n10 20 40 30 50\n4 8\n1\n"), HasSubstr("Fresnel's law needs an index"));
  EXPECT_THAT(error("x\nReflection\n"), HasSubstr("the end of the file"));
}

}  // namespace
}  // namespace burnish
