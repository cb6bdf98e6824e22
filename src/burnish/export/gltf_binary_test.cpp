#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/export/gltf_binary.h>
#include <burnish/fitting/parametric/gltf_json.h>

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

}  // namespace
}  // namespace burnish
