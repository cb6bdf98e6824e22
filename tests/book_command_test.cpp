// SPDX-License-Identifier: Apache-2.0
// These tests run `burnish book` and `fit --book` as programs.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;

class BookCommand : public testing::Test {
 protected:
  BookCommand() {
    std::string list;
    for (const char* alpha : {"0.15", "0.2", "0.3", "0.4", "0.5"})
      list += fmt::format("ggx:alpha_x={0},alpha_y={0}\n", alpha);
    write(folder_.path / "list", list);
    write(folder_.path / "one", "ggx:alpha_x=0.25,alpha_y=0.25\n");
    write(folder_.path / "with damage", list + "missing.csv\nggx:alpha_x=0.1,alpha_y=0.3\n");
  }
  Outcome burnish(const std::string& arguments) const {
    return run(fmt::format("cd {} && {} {}", folder_.path.string(), BURNISH_CLI, arguments));
  }
  static constexpr const char* kSmall = " --bytes 4K --bytes-a-material 8";
  TemporaryFolder folder_{"book_command"};
};

TEST_F(BookCommand, CompletesPairsAndOpensItsMaterials) {
  const Outcome made = burnish(std::string("book list -o a.book") + kSmall);
  ASSERT_EQ(made.status, 0) << made.output;
  EXPECT_THAT(made.output, HasSubstr("5 materials of 8 bytes each"));
  EXPECT_THAT(burnish("info a.book").output, HasSubstr("ggx_alpha_x_0.3_alpha_y_0.3"));
  const auto json = nlohmann::json::parse(burnish("info --json a.book").output);
  EXPECT_EQ(json["format"], "book");
  EXPECT_EQ(json["materials"].size(), 5u);
  EXPECT_EQ(burnish("compare ggx:alpha_x=0.3,alpha_y=0.3 book:a.book#ggx_alpha_x_0.3_alpha_y_0.3 --count 500")
                .status,
            0);

  ASSERT_EQ(burnish("measure ggx:alpha_x=0.35,alpha_y=0.35 -o pairs.csv --count 12").status, 0);
  const Outcome completed = burnish("fit pairs.csv --book a.book -o m.burnish");
  EXPECT_EQ(completed.status, 0) << completed.output;
  EXPECT_THAT(completed.output, HasSubstr("completed  12 pairs by a book of 5 materials"));
  EXPECT_THAT(completed.output, HasSubstr("left out in turn"));
  EXPECT_EQ(burnish("export m.burnish --to glsl -o out").status, 0);
  EXPECT_EQ(burnish("batch one -o batch --book a.book").status, 0);
  EXPECT_THAT(burnish("book one -o one.book --shared a.book").output, HasSubstr("book       1 material of"));
  EXPECT_THAT(burnish("fit-surface none --book a.book -o wall.burnish").output,
              HasSubstr("a.book: expected a model or a surface for --book, found a book of materials\n"));
}

TEST_F(BookCommand, SaysWhatIsWrong) {
  const Outcome damaged = burnish(std::string("book 'with damage' -o a.book") + kSmall);
  EXPECT_EQ(damaged.status, 1);
  EXPECT_THAT(damaged.output, HasSubstr("left out   missing: missing.csv"));
  EXPECT_THAT(damaged.output, HasSubstr("an isotropic material"));
  EXPECT_THAT(damaged.output,
              HasSubstr("burnish: 2 of 7 materials are not in the book; all other materials are\n"));
  EXPECT_THAT(burnish("info book:a.book#ggx").output, HasSubstr("a material named 'ggx', found 5 others"));
  EXPECT_THAT(burnish("compare lambert a.book").output, HasSubstr("book:FILE#NAME"));
  EXPECT_EQ(burnish("fit lambert --book list -o m.burnish").status, 1);
  EXPECT_EQ(burnish("fit lambert --book a.book --budget 2700 -o m.burnish").status, 2);
  EXPECT_EQ(burnish("fit ggx:alpha_x=0.1,alpha_y=0.3 --book a.book -o m.burnish").status, 1);
  EXPECT_FALSE(std::filesystem::exists(folder_.path / "m.burnish"));
  EXPECT_EQ(burnish("book list -o b.book --bytes 100").status, 1);
  EXPECT_FALSE(std::filesystem::exists(folder_.path / "b.book"));
}

}  // namespace
}  // namespace burnish
