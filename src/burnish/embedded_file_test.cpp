// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <gtest/gtest.h>

#include <burnish/embedded_file.h>

namespace burnish {
namespace {

TEST(EmbeddedFile, HasItsTextUnderItsName) {
  const EmbeddedFile files[] = {{"a", "first"}, {"b", "second"}};
  EXPECT_EQ(text_of(files, "b"), "second");
  EXPECT_THROW(text_of(files, "c"), std::logic_error);
}

TEST(WithMarks, ReplacesEveryMarkByItsTextAlone) {
  EXPECT_EQ(with_marks("@A_x = @AB(@A)", {{"A", "@B"}, {"AB", ""}}), "@B_x = (@B)");
  EXPECT_EQ(with_marks("", {}), "");
  EXPECT_THROW(with_marks("@C", {{"A", "B"}}), std::logic_error);
  EXPECT_THROW(with_marks("a@", {{"A", "B"}}), std::logic_error);
}

}  // namespace
}  // namespace burnish
