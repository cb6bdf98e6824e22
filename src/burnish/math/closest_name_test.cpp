// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <gtest/gtest.h>

#include <burnish/math/closest_name.h>

namespace burnish {
namespace {

TEST(ClosestName, CountsEdits) {
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("fit", "fit"), 0u);
  EXPECT_EQ(edit_distance("comapre", "compare"), 1u);
  EXPECT_EQ(edit_distance("conver", "convert"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(ClosestName, FindsWhatWasMeantAndNothingElse) {
  constexpr std::array<std::string_view, 4> verbs{"info", "fit", "compare", "convert"};
  EXPECT_EQ(closest_name("fti", verbs), "fit");
  EXPECT_EQ(closest_name("compair", verbs), "compare");
  EXPECT_EQ(closest_name("FIT", verbs), "fit") << "whatever the case";
  EXPECT_EQ(closest_name("nonsense", verbs), "");
  EXPECT_EQ(closest_name("", verbs), "");
  EXPECT_EQ(closest_name(std::string(100, 'f'), verbs), "");
  EXPECT_EQ(did_you_mean("inof", verbs), "; did you mean 'info'?");
  EXPECT_EQ(did_you_mean("x-rays", verbs), "");
  EXPECT_EQ(expected_one_of(verbs, "inof"),
            "expected one of info, fit, compare, convert, found 'inof'; did you mean 'info'?");
  EXPECT_EQ(listed(verbs), "info, fit, compare or convert");
  EXPECT_EQ(listed(std::span(verbs).first(2), "and"), "info and fit");
}

}  // namespace
}  // namespace burnish
