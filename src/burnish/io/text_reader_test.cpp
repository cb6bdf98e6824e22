// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/text_reader.h>
#include <burnish/testing/files.h>

namespace burnish {
namespace {

TEST(TextReader, SplitsLinesAndWords) {
  const FileBytes file = memory_file("\xef\xbb\xbf# remark\r\n\n  a, b\t3\r\nlast");
  TextReader reader(file);
  ASSERT_TRUE(reader.next_content_line());
  EXPECT_EQ(reader.word(), "a");
  EXPECT_EQ(reader.word(), "b");
  EXPECT_EQ(reader.number("a number"), 3);
  reader.end_of_line();
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.line(), "last");
  EXPECT_FALSE(reader.next_line());
}

TEST(TextReader, EndsLinesWhereOldSystemsDo) {
  const FileBytes file = memory_file("a\rb c\r\rd");
  TextReader reader(file);
  std::vector<std::string> lines;
  while (reader.next_line()) lines.emplace_back(reader.line());
  EXPECT_EQ(lines, (std::vector<std::string>{"a", "b c", "", "d"}));
  EXPECT_EQ(first_content_line("# x\rb\rc"), "b");
}

TEST(TextReader, NamesTheLineInItsErrors) {
  const FileBytes file = memory_file("1\n2 x\n");
  TextReader reader(file);
  reader.next_line();
  reader.next_line();
  EXPECT_EQ(reader.count("a count", 1, 5), 2u);
  EXPECT_EQ(error_of([&] { reader.end_of_line(); }),
            "test.file: line 2: expected the end of the line, found 'x'");
  EXPECT_THAT(error_of([&] { reader.count("a count", 1, 5); }), testing::HasSubstr("a count in [1, 5]"));
}

TEST(ParseNumber, TakesWholeFiniteNumbersOnly) {
  EXPECT_EQ(parse_number("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(parse_number("+2"), 2);
  for (const char* bad : {"", "1x", "nan", "inf", "-inf", "1e999", "0x10", "1,5", "--1"})
    EXPECT_EQ(parse_number(bad), std::nullopt) << bad;
}

TEST(Printable, HidesControlCharacters) {
  EXPECT_EQ(printable("a\x01z\x7f", 9), "a?z?");
  EXPECT_EQ(printable("abcdef", 3), "abc");
  EXPECT_EQ(in_quotes("\xff"), "'?'");
}

}  // namespace
}  // namespace burnish
