#include <gtest/gtest.h>

#include <burnish/io/utf16.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

std::optional<std::string> utf8_of(const std::string& bytes) {
  const auto file = from_utf16(memory_file(bytes));
  return file ? std::optional<std::string>(file->text()) : std::nullopt;
}

TEST(Utf16, BecomesUtf8InEitherOrder) {
  using namespace std::string_literals;
  EXPECT_EQ(utf8_of("\xff\xfe"s + "a\0\xb5\0\xac\x20\x3d\xd8\x00\xde"s), "a\xc2\xb5\xe2\x82\xac\xf0\x9f\x98\x80");
  EXPECT_EQ(utf8_of("\xfe\xff"s + "\0a\0\xb5\x20\xac\xd8\x3d\xde\x00"s), "a\xc2\xb5\xe2\x82\xac\xf0\x9f\x98\x80");
}

TEST(Utf16, IsNothingElse) {
  using namespace std::string_literals;
  for (const std::string& bytes :
       {"theta_i,theta_o"s, "\xff\xfe"s, "\xff\xfe\x41"s, "\xff\xfe\0\0"s, "\xff\xfe\x3d\xd8"s, "\xff\xfe\x3d\xd8\x41\x00"s,
        "\xff\xfe\x00\xde\x41\x00"s})
    EXPECT_EQ(utf8_of(bytes), std::nullopt);
}

}  // namespace
}  // namespace burnish
