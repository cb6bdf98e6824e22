#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/export/usda.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;

TEST(Usda, HasAPreviewAndOpenPbr) {
  OpenPbrParameters parameters;
  parameters.base_color = {0.25, 0.5, 0.125};
  const std::string text = usda_layer(parameters, {{0.5, 0.25, 1}, 0.75, 0.5}, "paint");
  EXPECT_TRUE(text.starts_with("#usda 1.0\n"));
  EXPECT_THAT(text, HasSubstr("defaultPrim = \"paint\""));
  EXPECT_THAT(text, HasSubstr("color3f inputs:diffuseColor = (0.5, 0.25, 1)\n"));
  EXPECT_THAT(text, HasSubstr("color3f inputs:base_color = (0.25, 0.5, 0.125)\n"));
  for (const OpenPbrInput& input : kOpenPbrInputs)
    EXPECT_EQ(text.find(" inputs:" + std::string(input.name) + " = ") != std::string::npos,
              input.name != "geometry_tangent");
  EXPECT_EQ(std::ranges::count(text, '{'), std::ranges::count(text, '}'));
  EXPECT_THROW(usda_layer(parameters, {}, "a\"b"), Error);
}

TEST(Usda, TurnsTangentsByNodes) {
  const std::string text = usda_layer({.geometry_tangent = 60}, {}, "metal");
  for (const char* of : {"geometry_tangent", "geometry_coat_tangent"})
    EXPECT_THAT(
        text, HasSubstr(fmt::format("float3 inputs:{}.connect = </metal/material/tangent.outputs:out>", of)));
  EXPECT_THAT(text, HasSubstr("def Shader \"tangent\""));
  EXPECT_EQ(std::ranges::count(text, '{'), std::ranges::count(text, '}'));
}

}  // namespace
}  // namespace burnish
