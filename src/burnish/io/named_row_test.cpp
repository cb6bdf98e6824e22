// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/named_row.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr NamedRowKind kRowKind{
    .count = 3, .number = "weight", .a_row = "encoding", .address = "nbrdf:FILE#NAME"};

NamedRow row_of(const std::string& text, std::string_view name = {}) {
  return parse_named_row(memory_file(text), name, kRowKind);
}

TEST(NamedRow, IsTheOnlyOneOrTheOneNamed) {
  const NamedRow only = row_of("red, 0.5,-1e-1 ,3\n");
  EXPECT_EQ(only.name, "red");
  EXPECT_EQ(only.numbers, (std::vector<float>{0.5f, -0.1f, 3}));
  const std::string several = "red2,7,8,9\n\nblue,4,5,6\nred,1,2,3";
  EXPECT_EQ(row_of(several, "blue").numbers, (std::vector<float>{4, 5, 6}));
  EXPECT_EQ(row_of(several, "red2").numbers, (std::vector<float>{7, 8, 9}));
  EXPECT_EQ(row_of(several, "red").numbers, (std::vector<float>{1, 2, 3}));
}

TEST(NamedRow, OfSeveralIsAskedForByTheNamesThatThereAre) {
  const std::string several = "a,1,2,3\nb,1,2,3\nc,1,2,3\nd,1,2,3\ne,1,2,3\nf,1,2,3\ng,1,2,3\n";
  EXPECT_THAT(error_of([&] { row_of(several); }),
              AllOf(HasSubstr("nbrdf:FILE#NAME"), HasSubstr("a, b, c, d, e and 2 more")));
  EXPECT_THAT(error_of([&] { row_of(several, "h"); }),
              AllOf(HasSubstr("an encoding named 'h'"), HasSubstr("a, b, c, d, e and 2 more")));
  EXPECT_THAT(error_of([&] { row_of("", "h"); }), HasSubstr("no row"));
}

TEST(NamedRow, OfOtherNumbersIsRefused) {
  EXPECT_THAT(error_of([&] { row_of("red,1,2\n"); }), HasSubstr("weight 3"));
  EXPECT_THAT(error_of([&] { row_of("red,1,two,3\n"); }), HasSubstr("weight 2"));
  EXPECT_THROW(row_of("red,1,2,3,4\n"), Error);
  EXPECT_THROW(row_of("red,1,nan,3\n"), Error);
  EXPECT_THAT(error_of([&] { row_of("a red,1,2,3\n"); }), HasSubstr("a name without blanks"));
  EXPECT_THROW(row_of(",1,2,3\n"), Error);
}

}  // namespace
}  // namespace burnish
