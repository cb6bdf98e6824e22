#include <cmath>
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
  parameters.base_weight = 0.5;
  const std::string text = usda_layer(parameters, "paint");
  EXPECT_TRUE(text.starts_with("#usda 1.0\n"));
  EXPECT_THAT(text, HasSubstr("defaultPrim = \"paint\""));
  EXPECT_THAT(text, HasSubstr("color3f inputs:diffuseColor = (0.125, 0.25, 0.0625)\n"));
  EXPECT_THAT(text, HasSubstr("color3f inputs:base_color = (0.25, 0.5, 0.125)\n"));
  for (const OpenPbrInput& input : kOpenPbrInputs)
    EXPECT_THAT(text, HasSubstr(" inputs:" + std::string(input.name) + " = "));
  EXPECT_EQ(std::ranges::count(text, '{'), std::ranges::count(text, '}'));
  EXPECT_THROW(usda_layer(parameters, "a\"b"), Error);
}

// OpenPBR's alphas as its specification has them, GGX's of the core material as glTF's has them.
TEST(Usda, OpenPbrHasTheCoreMaterialsAlphas) {
  for (const double anisotropy : {0.0, 0.3, 0.9, 1.0})
    for (const double roughness : {0.03, 0.4, 1.0}) {
      const MetallicRoughness core{{0.9, 0.5, 0.1}, 0.7, roughness, anisotropy, false};
      const OpenPbrParameters p = openpbr_of(core);
      const double across = 1 - p.specular_roughness_anisotropy,
                   alpha_x =
                       p.specular_roughness * p.specular_roughness * std::sqrt(2 / (1 + across * across));
      const double alpha = roughness * roughness;
      EXPECT_NEAR(alpha_x, alpha + (1 - alpha) * anisotropy * anisotropy, 1e-12);
      EXPECT_NEAR(across * alpha_x, alpha, 1e-12);
      EXPECT_GE(p.specular_roughness, 0);
      EXPECT_LE(p.specular_roughness, 1);
      EXPECT_EQ(p.base_color, core.base_color);
      EXPECT_EQ(p.base_metalness, core.metallic);
    }
}

}  // namespace
}  // namespace burnish
