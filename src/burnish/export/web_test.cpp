// SPDX-License-Identifier: Apache-2.0
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/export/tsl_function.h>
#include <burnish/export/web.h>
#include <burnish/export/web_module.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;

std::string encoded(std::string_view text) {
  return base64(std::as_bytes(std::span(text)));
}

// RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xfb\xff\xbe"), "+/++");
}

TEST(HalfTexels, HaveFourChannelsOfTwoBytes) {
  for (const std::size_t channels : {std::size_t{1}, std::size_t{3}})
    EXPECT_EQ(half_texels(std::vector<float>(6 * channels, 0.5f), channels).size(), 6u * 8 / 3 * 4);
}

TEST(WebScript, PutsTheModelInItsPlace) {
  ASSERT_FALSE(web_files().empty());
  const std::string script = web_script("three.js", "{\"here\": 1}");
  EXPECT_NE(script.find("{\"here\": 1}"), std::string::npos);
  EXPECT_EQ(script.find("MODEL"), std::string::npos);
}

// tests/web/nodes.mjs draws it in Chromium.
TEST(ThreeModule, MakesBothMaterialsOfAModel) {
  const std::string text = three_module(smooth_model(model_case("Volume")), {}, "m");
  EXPECT_THAT(text, HasSubstr("export function createMaterial(THREE)"));
  EXPECT_THAT(text, HasSubstr("export function createNodeMaterial(THREE)"));
  EXPECT_THAT(text, HasSubstr("read(\"burnish_m_volumes\", "));
}

TEST(TslFunction, NamesValuesThatAreUsedAgain) {
  const ExprVector wi(Expr::input("wi", ValueType::vector)), wo(Expr::input("wo", ValueType::vector));
  const Expr sum = wi.x + wo.z;
  const std::string text = tsl_function(sum * sqrt(sum));
  EXPECT_THAT(text, HasSubstr("= set(\"float\", wi.x.add(wo.z));"));
  EXPECT_THAT(text, HasSubstr(".sqrt()"));
  EXPECT_THROW(tsl_function(Expr::texel("t", {0.0, 0.0}, ValueType::real)), Error);
}

}  // namespace
}  // namespace burnish
