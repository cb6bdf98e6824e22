// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/fitting/parametric/gltf_json.h>

namespace burnish {
namespace {

using Json = nlohmann::json;

TEST(GltfJson, HasNoExtensionThatDoesNothing) {
  EXPECT_EQ(Json(gltf_json({.base_color = {0.5, 0.2, 0.1}, .metallic = 0, .roughness = 0.25})),
            Json::parse(R"({
    "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.2, 0.1, 1], "metallicFactor": 0.0, "roughnessFactor": 0.25}
  })"));
}

TEST(GltfJson, HasAnExtensionForEachLayer) {
  const Json found = gltf_json({.ior = 2,
                                .specular = 0.5,
                                .anisotropy = 0.25,
                                .rotation = 1.5,
                                .iridescence = 1,
                                .iridescence_thickness = 500,
                                .sheen_color = {0.5, 0.25, 0},
                                .sheen_roughness = 0.75,
                                .clearcoat = 1,
                                .clearcoat_roughness = 0.125});
  EXPECT_EQ(found["extensions"], Json::parse(R"({
    "KHR_materials_ior": {"ior": 2.0},
    "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1.0, 1.0, 1.0]},
    "KHR_materials_anisotropy": {"anisotropyStrength": 0.25, "anisotropyRotation": 1.5},
    "KHR_materials_iridescence": {"iridescenceFactor": 1.0, "iridescenceIor": 1.3, "iridescenceThicknessMaximum": 500.0},
    "KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.25, 0.0], "sheenRoughnessFactor": 0.75},
    "KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.125}
  })"));
}

}  // namespace
}  // namespace burnish
