// SPDX-License-Identifier: Apache-2.0
// These tests use the manual pages and completions of `burnish describe` as man and the shells do.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/fitting/fit_request.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kDescribe = std::string(BURNISH_CLI) + " describe ";

/// Returns bash's proposals after these words. The last word is being typed.
std::string proposed(const std::string& words) {
  return run(fmt::format(
                 "bash -c 'source <({} --bash); COMP_WORDS=({}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); "
                 "cd /usr; _burnish; echo ${{COMPREPLY[*]}}'",
                 kDescribe, words))
      .output;
}

TEST(Describe, GivesEachVerbAManualPage) {
  const TemporaryFolder folder("describe");
  ASSERT_EQ(run(kDescribe + "--man " + folder.path.string()).status, 0);
  const std::string program = read(folder.path / "burnish.1");
  for (const char* verb : {"info", "fit", "eval", "compare", "measure", "convert", "export", "render"}) {
    const std::string page = read(folder.path / fmt::format("burnish-{}.1", verb));
    EXPECT_THAT(page, HasSubstr(fmt::format("burnish\\-{} \\- ", verb)));
    EXPECT_THAT(page, HasSubstr(".SH EXAMPLES")) << verb;
    EXPECT_THAT(program, HasSubstr(fmt::format(".B {}\n", verb)));
  }
  EXPECT_THAT(read(folder.path / "burnish-fit.1"),
              HasSubstr("\\fB\\-\\-loss\\fR \\fIimage|relative|log_cos\\fR"));
  EXPECT_THAT(read(folder.path / "burnish-specular.1"), HasSubstr("burnish specular code"));
  EXPECT_FALSE(std::filesystem::exists(folder.path / "burnish-describe.1"))
      << "is for whoever packages burnish";
}

TEST(Describe, CompletesInBash) {
  EXPECT_EQ(proposed("burnish mea"), "measure\n");
  EXPECT_EQ(proposed("burnish fit --lo"), "--lobes --loss\n");
  EXPECT_EQ(proposed("burnish fit --loss \"\""), "image relative log_cos\n");
  EXPECT_EQ(proposed("burnish specular co"), "code\n");
  EXPECT_EQ(proposed("burnish fit paint.binary -o shar"), "share\n");
  EXPECT_THAT(proposed("burnish eval --"), Not(HasSubstr("--loss")));
}

TEST(Describe, CompletesInZsh) {
  if (!has_tool("zsh")) GTEST_SKIP() << "no zsh";
  EXPECT_EQ(run(kDescribe + "--zsh | zsh -n /dev/stdin").status, 0);
}

TEST(Describe, HasTheTableOfFitOptions) {
  const auto told = nlohmann::json::parse(run(kDescribe + "--json").output);
  const auto& rows = told.at("fit_options");
  const auto& verbs = told.at("verbs");
  for (const char* name : {"fit", "batch"}) {
    const auto verb = std::ranges::find_if(verbs, [&](const auto& each) { return each.at("name") == name; });
    ASSERT_NE(verb, verbs.end());
    std::vector<std::string> words;
    for (const auto& argument : verb->at("arguments"))
      for (const auto& word : argument.at("names")) words.push_back(word.get<std::string>());
    for (const auto& row : rows)
      EXPECT_THAT(words, testing::Contains(row.at("command_line").get<std::string>())) << name;
  }
  EXPECT_EQ(rows.size(), fit_option_table().size());
}

TEST(Describe, SaysOneThingAtATime) {
  EXPECT_EQ(run(kDescribe).status, 2);
  EXPECT_EQ(run(kDescribe + "--bash --zsh").status, 2);
}

}  // namespace
}  // namespace burnish
