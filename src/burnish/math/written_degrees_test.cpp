// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/math/random.h>
#include <burnish/math/written_degrees.h>

namespace burnish {
namespace {

TEST(WrittenDegrees, AreWhatWasRead) {
  for (int i = 0; i <= 36000; ++i) {
    const double deg = i / 100.0;
    EXPECT_EQ(written_degrees(radians(deg)), deg);
    EXPECT_EQ(fmt::format("{}", written_degrees(radians(deg + 90), 90)), fmt::format("{}", deg));
  }
}

TEST(WrittenDegrees, GiveTheAngleBack) {
  Pcg32 random(1);
  for (int i = 0; i < 10000; ++i) {
    const double rad = kPi * random.uniform();
    EXPECT_NEAR(radians(written_degrees(rad)), rad, 1e-15 * rad);
  }
  EXPECT_EQ(written_degrees(0), 0);
}

}  // namespace
}  // namespace burnish
