// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/io/csv.h>
#include <burnish/io/open_source.h>
#include <burnish/io/utf16.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

std::optional<std::string> utf8_of(const std::string& bytes) {
  const auto file = from_utf16(memory_file(bytes));
  return file ? std::optional<std::string>(file->text()) : std::nullopt;
}

TEST(Utf16, BecomesUtf8InEitherOrder) {
  using namespace std::string_literals;
  EXPECT_EQ(utf8_of("\xff\xfe"s + "a\0\xb5\0\xac\x20\x3d\xd8\x00\xde"s),
            "a\xc2\xb5\xe2\x82\xac\xf0\x9f\x98\x80");
  EXPECT_EQ(utf8_of("\xfe\xff"s + "\0a\0\xb5\x20\xac\xd8\x3d\xde\x00"s),
            "a\xc2\xb5\xe2\x82\xac\xf0\x9f\x98\x80");
}

TEST(Utf16, IsNothingElse) {
  using namespace std::string_literals;
  for (const std::string& bytes :
       {"theta_i,theta_o"s, "\xff\xfe"s, "\xff\xfe\x41"s, "\xff\xfe\0\0"s, "\xff\xfe\x3d\xd8"s,
        "\xff\xfe\x3d\xd8\x41\x00"s, "\xff\xfe\x00\xde\x41\x00"s})
    EXPECT_EQ(utf8_of(bytes), std::nullopt);
}

TEST(Utf16, IsReadWhereTextIs) {
  std::string text("\xff\xfe", 2), directions = text;
  for (const char c : std::string("theta_i;theta_o;value\n10;-10;0,5\n")) text += {c, '\0'};
  for (const char c : std::string("theta_i\ttheta_o\n10\t-10\n")) directions += {c, '\0'};
  const Source source = parse_source(memory_file(text), {});
  ASSERT_NE(source.samples(), nullptr);
  EXPECT_EQ(source.samples()->values, std::vector<double>{0.5});
  EXPECT_TRUE(looks_like_source(memory_file(text)));
  EXPECT_EQ(parse_directions(memory_file(directions)).numbers, (std::vector<double>{10, -10}));
}

}  // namespace
}  // namespace burnish
