// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

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

// Each corner lies on the unit sphere, and a texture coordinate and a normal belong to it.
TEST(Usda, HasASphereWithTextureCoordinates) {
  const std::string text = usda_layer({}, {}, "paint");
  const auto numbers = [&](const std::string& name) {
    const std::size_t from = text.find(name + " = [") + name.size() + 4;
    std::string list = text.substr(from, text.find(']', from) - from);
    std::ranges::replace_if(
        list, [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
    std::istringstream in(list);
    return std::vector<double>(std::istream_iterator<double>(in), {});
  };
  const std::vector<double> points = numbers("points"), normals = numbers("normals"),
                            uvs = numbers("primvars:st"), counts = numbers("faceVertexCounts"),
                            indices = numbers("faceVertexIndices");
  ASSERT_GT(points.size(), 3000u);
  EXPECT_EQ(points.size(), normals.size());
  EXPECT_EQ(points.size() / 3, uvs.size() / 2);
  for (std::size_t i = 0; i < points.size(); i += 3)
    EXPECT_NEAR(std::hypot(points[i], points[i + 1], points[i + 2]), 1, 1e-5);
  EXPECT_EQ(indices.size(), 3 * counts.size());
  EXPECT_EQ(std::ranges::max(indices), static_cast<double>(points.size()) / 3 - 1);
  EXPECT_EQ(std::ranges::min(uvs), 0);
  EXPECT_EQ(std::ranges::max(uvs), 1);
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
