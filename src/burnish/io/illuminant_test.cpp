// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/illuminant.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;

class IlluminantFile : public ::testing::Test {
 protected:
  Illuminant of(std::string_view text) const {
    write(folder_.path / "light.txt", std::string(text));
    return open_illuminant((folder_.path / "light.txt").string());
  }

 private:
  TemporaryFolder folder_{"illuminant"};
};

TEST_F(IlluminantFile, IsRowsOfWavelengthAndPower) {
  const Illuminant light = of("# a lamp\n400 0.5\n700.5\t2e3\n");
  EXPECT_EQ(light.lambda_nm, (std::vector<double>{400, 700.5}));
  EXPECT_EQ(light.power, (std::vector<double>{0.5, 2000}));
  EXPECT_EQ(open_illuminant("D50").name, "D50");
  EXPECT_EQ(parse_illuminant(memory_file(seeds::kIlluminant)).power, (std::vector<double>{0.5, 1, 2000}));
}

TEST_F(IlluminantFile, SaysWhatIsWrong) {
  EXPECT_THAT(error_of([&] { of("400 1\n400 1\n"); }), HasSubstr("line 2: expected increasing wavelengths"));
  EXPECT_THAT(error_of([&] { of("-1 1\n500 1\n"); }), HasSubstr("line 1: expected increasing wavelengths"));
  EXPECT_THAT(error_of([&] { of("400 1\n500 -1\n"); }), HasSubstr("line 2: expected a power of at least 0"));
  EXPECT_THAT(error_of([&] { of("400 1\n500 1e31\n"); }), HasSubstr("a power of at least 0"));
  EXPECT_THAT(error_of([&] { of("400 1 2\n500 1\n"); }), HasSubstr("line 1"));
  EXPECT_THAT(error_of([&] { of("400 x\n"); }), HasSubstr("expected a finite number for a power"));
  EXPECT_THAT(error_of([&] { of("400 1\n"); }), HasSubstr("two rows of wavelength and power"));
  EXPECT_THAT(error_of([&] { of(""); }), HasSubstr("an empty file"));
  EXPECT_THAT(error_of([] { open_illuminant("/nowhere/light"); }), HasSubstr("/nowhere/light"));
}

}  // namespace
}  // namespace burnish
