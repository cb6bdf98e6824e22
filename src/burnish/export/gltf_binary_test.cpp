// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/export/gltf_binary.h>
#include <burnish/fitting/parametric/gltf_json.h>
#include <burnish/image/png.h>
#include <burnish/testing/surfaces.h>

namespace burnish {
namespace {

using nlohmann::json;

json document_of(const GltfMaterial& material) {
  const std::string file = gltf_binary(gltf_json(material), "paint");
  EXPECT_EQ(file.substr(0, 4), "glTF");
  const std::size_t size =
      static_cast<unsigned char>(file[12]) + (std::size_t{static_cast<unsigned char>(file[13])} << 8);
  return json::parse(file.substr(20, size));
}

TEST(GltfBinary, NamesTheExtensionsItUses) {
  const json plain = document_of({}), coated = document_of({.sheen_color = 0.5, .clearcoat = 0.5});
  EXPECT_FALSE(plain.contains("extensionsUsed"));
  EXPECT_FALSE(plain["materials"][0].contains("extensions"));
  EXPECT_EQ(coated["extensionsUsed"], json({"KHR_materials_clearcoat", "KHR_materials_sheen"}));
  EXPECT_EQ(coated["materials"][0]["extensions"],
            json(gltf_json({.sheen_color = 0.5, .clearcoat = 0.5}))["extensions"]);
}

TEST(GltfBinary, HasASurfacesTexturesAndItsShape) {
  const SpatialBrdf surface = random_surface(8, 4);
  TexelMaterials materials{.width = 8, .height = 4, .base_color = {}, .metallic = {}, .roughness = {}};
  for (int t = 0; t < 32; ++t) {
    for (const int c : {1, 2, 3}) materials.base_color.push_back(static_cast<std::uint8_t>(t * c));
    materials.metallic.push_back(static_cast<std::uint8_t>(200 + t));
    materials.roughness.push_back(static_cast<std::uint8_t>(100 + t));
  }
  const std::string file = gltf_binary(surface, materials, "wall");
  const std::size_t size =
      static_cast<unsigned char>(file[12]) + (std::size_t{static_cast<unsigned char>(file[13])} << 8);
  const json document = json::parse(file.substr(20, size));
  const auto picture = [&](const json& texture) {
    const json& view =
        document["bufferViews"]
                [document["images"][texture["index"].get<std::size_t>()]["bufferView"].get<std::size_t>()];
    return decode_png(file.substr(28 + size + view["byteOffset"].get<std::size_t>(), view["byteLength"]),
                      "texture");
  };
  const json& material = document["materials"][0];
  EXPECT_EQ(picture(material["pbrMetallicRoughness"]["baseColorTexture"]).pixels, materials.base_color);
  const Image8 rest = picture(material["pbrMetallicRoughness"]["metallicRoughnessTexture"]),
               normals = picture(material["normalTexture"]);
  for (std::size_t t = 0; t < 32; ++t) {
    EXPECT_EQ(rest.pixels[3 * t + 1], materials.roughness[t]);
    EXPECT_EQ(rest.pixels[3 * t + 2], materials.metallic[t]);
    const auto n = surface.maps().normals->texel(static_cast<int>(t % 8), static_cast<int>(t / 8));
    for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(normals.pixels[3 * t + c], 127.5 * (n[c] + 1.0), 0.51);
  }
  const json& corners =
      document["accessors"]
              [document["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_NEAR(corners["max"][0].get<double>() / corners["max"][1].get<double>(), 2, 1e-6);
}

}  // namespace
}  // namespace burnish
