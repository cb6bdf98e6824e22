// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/power/choose.h>

namespace burnish {
namespace {

TEST(ChoosePower, CoversTheRangeWithoutGapsWithinTheError) {
  Pcg32 random(1);
  for (double max_error : {0.3, 0.05, 1.0 / 255, 4e-4, 3e-6, 0.0}) {
    const auto choices = choose_power(max_error, 1, 1000);
    EXPECT_EQ(choices.front().min_exponent, 1);
    EXPECT_EQ(choices.back().max_exponent, 1000);
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (i > 0) {
        EXPECT_EQ(choices[i].min_exponent, choices[i - 1].max_exponent);
        EXPECT_NE(choices[i].method, choices[i - 1].method);
      }
      EXPECT_LE(choices[i].bound, max_error);
      for (int j = 0; j < 200; ++j) {
        const double e = choices[i].min_exponent *
                         std::pow(choices[i].max_exponent / choices[i].min_exponent, random.uniform());
        const double c = j % 2 ? random.uniform() : std::max(0.0, 1 - 8 / e * random.uniform());
        EXPECT_NEAR(power(choices[i].method, c, e), std::pow(c, e), max_error + 1e-13);
      }
    }
  }
}

TEST(ChoosePower, TakesTheSquaredCubicForEightBitsFromOneAndAHalf) {
  bool cubic = false;
  for (const PowerChoice& choice : choose_power(1.0 / 255, 1.5, 1000))
    cubic |= choice.method == PowerMethod::cubic2;
  EXPECT_TRUE(cubic);
}

TEST(ChoosePower, KnowsTheSpecialExponents) {
  for (double e : {1.0, 2.0}) {
    const auto choices = choose_power(0, e, e);
    ASSERT_EQ(choices.size(), 1u);
    EXPECT_EQ(choices[0].method, PowerMethod::quadratic);
    EXPECT_NEAR(power(choices[0].method, 0.3, e), std::pow(0.3, e), 1e-16);
  }
  EXPECT_EQ(choose_power(0.01, 7, 7).size(), 1u);
}

TEST(ChoosePower, RefusesNonsense) {
  EXPECT_THROW(choose_power(-1, 1, 10), Error);
  EXPECT_THROW(choose_power(NAN, 1, 10), Error);
  EXPECT_THROW(choose_power(0.1, 0.5, 10), Error);
  EXPECT_THROW(choose_power(0.1, 10, 9), Error);
  EXPECT_THROW(choose_power(0.1, 1, 2000), Error);
}

}  // namespace
}  // namespace burnish
