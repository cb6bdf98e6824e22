// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/astm.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>

namespace burnish {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(Astm, ReadsTheHeaderAndRows) {
  const std::string text =
      "SAMPLE brushed steel\nNUM_POINTS 2\nVARS theta_i,phi_i,theta_s,phi_s,Red BRDF,Green BRDF,Blue BRDF\n"
      "0.1,0.2,0.3,0.4,1,2,3\n0.1, 0.5, 0.3, 0.4, 4, 5, 6\n";
  EXPECT_TRUE(looks_like_astm(text));
  const SampleFile file = parse_astm(memory_file(text), {});
  ASSERT_EQ(file.samples.size(), 2u);
  EXPECT_EQ(file.samples.channels, 3);
  EXPECT_FALSE(file.samples.isotropic);
  EXPECT_NEAR(length(file.samples.pairs[1].wi - spherical_direction(0.1, 0.5)), 0, 1e-15);
  EXPECT_NEAR(length(file.samples.pairs[1].wo - spherical_direction(0.3, 0.4)), 0, 1e-15);
  EXPECT_EQ(file.samples.at(1)[2], 6);
}

TEST(Astm, AcceptsAForgottenPhiSWhereTheRowsSettleIt) {
  const SampleFile file = parse_astm(memory_file("VARS theta_i,phi_i,theta_s,BRDF\n0.1 0.2 0.3 0.4 7\n"), {});
  EXPECT_NEAR(length(file.samples.pairs[0].wo - spherical_direction(0.3, 0.4)), 0, 1e-15);
  EXPECT_EQ(file.samples.values, std::vector<double>{7});
  EXPECT_THAT(file.findings.conventions, Contains(HasSubstr("leaves out phi_s")));
  EXPECT_THAT(
      error_of([] { parse_astm(memory_file("VARS theta_i,phi_i,theta_s,BRDF\n0.1 0.2 0.3 0.4\n"), {}); }),
      HasSubstr("phi_s in the VARS line"));
}

TEST(Astm, TakesTheCosineOutOfCcbrdfAndPiOutOfFactors) {
  const auto f = [](std::string_view name, const OpenOptions& options = {}) {
    const std::string text = fmt::format("VARS theta_i,phi_i,theta_s,phi_s,{}\n0.1,0,1,2,0.3\n", name);
    return parse_astm(memory_file(text), options).samples.values[0];
  };
  EXPECT_EQ(f("BRDF"), 0.3);
  EXPECT_EQ(f("anything"), 0.3);
  EXPECT_NEAR(f("CCBRDF"), 0.3 / std::cos(1.0), 1e-15);
  EXPECT_NEAR(f("BRF"), 0.3 / kPi, 1e-15);
  EXPECT_NEAR(f("BRDF", {.has_cosine_o = true}), 0.3 / std::cos(1.0), 1e-15);
  EXPECT_NEAR(f("BRDF", {.has_cosine = true}), 0.3 / std::cos(0.1), 1e-15);
  const auto file = parse_astm(memory_file("VARS theta_i,phi_i,theta_s,phi_s,CCBRDF\n0.1,0,1,2,0.3\n"), {});
  EXPECT_THAT(file.findings.conventions,
              Contains(HasSubstr("theta_o was divided out, as the name 'CCBRDF' says")));
}

TEST(Astm, SaysWhatIsWrong) {
  const auto error = [](std::string_view text) {
    return error_of([&] { parse_astm(memory_file(text), {}); });
  };
  EXPECT_THAT(error("KEY value\n"), HasSubstr("a VARS line"));
  EXPECT_THAT(error("VARS theta_i,theta_s,phi_s,BRDF\n1 1 1 1\n"), HasSubstr("phi_i once"));
  EXPECT_THAT(error("VARS theta_i,phi_i,theta_s,phi_s,a,b\n.1 .1 .1 .1 1 1\n"),
              HasSubstr("one, three or one a wavelength"));
  EXPECT_THAT(error("VARS theta_i,phi_i,theta_s,phi_s,a\n.1 .1 2 .1 1\n"), HasSubstr("theta_s within"));
  EXPECT_THAT(error("VARS theta_i,phi_i,theta_s,phi_s,a\n.1 .1 20 .1 1\n"), HasSubstr("found 20: degrees?"));
  EXPECT_THAT(error("VARS theta_i,phi_i,theta_s,phi_s,a\n.1 .1 .1 .1\n"), HasSubstr("finite number for a"));
  EXPECT_THAT(error("VARS theta_i,phi_i,theta_s,phi_s,a\n"), HasSubstr("at least one measurement"));
}

}  // namespace
}  // namespace burnish
