// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/fred.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::HasSubstr;

const std::string kHead = "type bsdf_data\nformat angles=deg bsdf=value scale=1\n";

TEST(Fred, CountsFromTheSpecularDirection) {
  EXPECT_TRUE(looks_like_fred(seeds::kFred));
  EXPECT_TRUE(looks_like_fred("! a remark is none of it\n") == false);
  EXPECT_TRUE(looks_like_fred("# remark\nTYPE  BSDF_DATA\n"));
  const SampleFile file = parse_fred(memory_file(kHead + "30\t0\n30\t0\t0.5\n! remark\n60\t90\t0.1\n"), {});
  ASSERT_EQ(file.samples.size(), 2u);
  EXPECT_TRUE(file.samples.isotropic);
  EXPECT_EQ(file.samples.values, (std::vector<double>{0.5, 0.1}));
  const auto& [wi, wo] = file.samples.pairs[0];
  EXPECT_NEAR(length(wi - spherical_direction(radians(30), kPi)), 0, 1e-15);
  EXPECT_NEAR(length(wo - mirror(wi)), 0, 1e-15);
}

TEST(Fred, ReadsUnitsAndScale) {
  const SampleFile file =
      parse_fred(memory_file("type bsdf_data\nformat angles=rad bsdf=value scale=0.25\n0.5 0\n1 2 8\n"), {});
  EXPECT_EQ(file.samples.values, std::vector<double>{2});
  EXPECT_NEAR(length(file.samples.pairs[0].wo - spherical_direction(1, 2)), 0, 1e-15);
}

TEST(Fred, SaysWhatIsWrong) {
  const auto error = [](const std::string& text) {
    return error_of([&] { parse_fred(memory_file(text), {}); });
  };
  EXPECT_THAT(error("type bsdf_data\n"), HasSubstr("a line 'format ...'"));
  EXPECT_THAT(error("type bsdf_data\nformat angles=sin\n"), HasSubstr("'angles=sin'"));
  EXPECT_THAT(error("type bsdf_data\nformat bsdf=log\n"), HasSubstr("'bsdf=log'"));
  EXPECT_THAT(error(kHead + "10 20 1\n"), HasSubstr("a specular direction before values"));
  EXPECT_THAT(error(kHead + "10 20\n1\n"), HasSubstr("theta, phi and a value"));
  EXPECT_THAT(error(kHead + "10 20\n100 0 1\n"), HasSubstr("above the horizon"));
  EXPECT_THAT(error(kHead + "10 20\n10 0 inf\n"), HasSubstr("a finite number for a value"));
  EXPECT_THAT(error(kHead + "10 20\n"), HasSubstr("at least one measurement"));
}

}  // namespace
}  // namespace burnish
