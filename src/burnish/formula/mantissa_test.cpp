// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/formula/language.h>
#include <burnish/formula/mantissa.h>

namespace burnish {
namespace {

TEST(Mantissa, IsSplitAlikeInEveryLanguage) {
  const std::string bits = fmt::format("- 0x{:08x})", kLeastMantissaBits);
  const std::string range = fmt::format("m in [{:.3g}, {:.3g})", kLeastMantissa, 2 * kLeastMantissa);
  int count = 0;
  for (const Language& language : languages()) {
    if (language.exponent_of.empty()) continue;
    ++count;
    EXPECT_NE(language.exponent_of.find(bits), std::string::npos) << language.exponent_of;
    EXPECT_NE(language.exponent_of.find(range), std::string::npos) << language.exponent_of;
  }
  EXPECT_GE(count, 7);
}

}  // namespace
}  // namespace burnish
