// SPDX-License-Identifier: Apache-2.0
// These tests run the `specular` verb as a user does.
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;

Outcome run_specular(const std::string& arguments, const std::string& input = "") {
  return run(fmt::format("printf '{}' | '{}' specular {}", input, BURNISH_CLI, arguments));
}

TEST(SpecularVerb, EvaluatesOneCosineALine) {
  const Outcome outcome = run_specular("eval --method rational --exponent 1", "1\\n0.5\\n0\\n");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.output, "1\n0.5\n0\n");
}

TEST(SpecularVerb, RefusesWhatIsNoCosineNamingTheLine) {
  for (const char* bad :
       {"1\\nabc\\n", "1\\n1.5\\n", "1\\n-0.1\\n", "1\\nnan\\n", "1\\n\\n", "1\\n0.5x\\n"}) {
    const Outcome outcome = run_specular("eval --method w8 --exponent 9", bad);
    EXPECT_EQ(outcome.status, 1) << bad;
    EXPECT_THAT(outcome.output, HasSubstr("standard input: line 2: expected a cosine in [0, 1]"));
  }
}

TEST(SpecularVerb, ChoosesListsAndWritesCode) {
  const Outcome chosen = run_specular("choose --max-error 1/255 --exponents 1.5:1000");
  EXPECT_EQ(chosen.status, 0);
  EXPECT_THAT(chosen.output, HasSubstr("cubic2"));
  EXPECT_THAT(chosen.output, HasSubstr("float power_cubic2(float c, float e)"));
  EXPECT_THAT(run_specular("list --json").output, HasSubstr("\"name\": \"near_exact\""));
  EXPECT_THAT(run_specular("code --method w8 --lang wgsl --exponent 30").output,
              HasSubstr("fn power_w8(c: f32) -> f32"));
  EXPECT_THAT(run_specular("table --count 2").output, HasSubstr("exponent,a\n1,0\n2,"));
}

TEST(SpecularVerb, ExitsWithOneForBadInputAndTwoForMisuse) {
  EXPECT_EQ(run_specular("plot --figure 2a -o /nonexistent/a.svg").status, 1);
  for (const char* misuse :
       {"", "eval --method nothing --exponent 9", "eval --method cubic4 --exponent 2",
        "code --method nothing", "code --lang cobol", "code --method cubic4 --exponent 2",
        "choose --max-error 1/0", "choose --exponents 9:3", "choose --exponents 1:x", "choose --lang cobol",
        "table --count 0", "plot --figure 9 -o a.svg", "plot --figure 2a -o a.txt",
        "plot --method nothing -o a.svg", "plot --figure sphere --exponent 0.5 -o a.png"})
    EXPECT_EQ(run_specular(misuse).status, 2) << misuse;
  EXPECT_EQ(run_specular("choose --lang cobol").output.find("// exponents"), std::string::npos);
  EXPECT_EQ(run_specular("choose --help").status, 0);
}

}  // namespace
}  // namespace burnish
