// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/short_message.h>

namespace burnish {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(ShortMessage, KeepsShortLines) {
  EXPECT_EQ(short_message(""), "");
  EXPECT_EQ(short_message("a: expected b, found c\n"), "a: expected b, found c");
  EXPECT_EQ(short_message("two\nlines\tof\x01words \r\n"), "two lines of words");
  EXPECT_EQ(short_message(std::string(285, 'x')), std::string(285, 'x'));
}

TEST(ShortMessage, KeepsBothEndsOfLongOnes) {
  const std::string cut = short_message("begin" + std::string(7000, 'x') + "end");
  EXPECT_EQ(cut.size(), 285);
  EXPECT_THAT(cut, StartsWith("begin"));
  EXPECT_THAT(cut, HasSubstr(" ... "));
  EXPECT_THAT(cut, EndsWith("end"));
  EXPECT_EQ(short_message(cut), cut);
}

TEST(ShortMessage, CutsNoCharacterOfUtf8) {
  for (int shift = 0; shift < 4; ++shift) {
    std::string message(static_cast<std::size_t>(shift), 'x');
    for (int i = 0; i < 400; ++i) message += "\xe2\x82\xac";  // a euro sign
    const std::string cut = short_message(message);
    EXPECT_LE(cut.size(), 285);
    const auto gap = cut.find(" ... ");
    EXPECT_EQ((gap - static_cast<std::size_t>(shift)) % 3, 0);
    EXPECT_EQ((cut.size() - gap - 5) % 3, 0);
  }
}

TEST(Error, IsOneLineBelow300Characters) {
  const std::string longest(7000, 'x');
  for (const Error& error : {Error(longest), Error(longest, 7, "a", "b"), Error::in_file("a", longest, "b"),
                             Error::in_line("a", 1, "b", longest + "\n" + longest)}) {
    EXPECT_EQ(std::string(error.what()).size(), 285);
    EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("\n")));
  }
}

}  // namespace
}  // namespace burnish
