#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/export/gltf_binary.h>
#include <burnish/export/usda.h>

namespace burnish {
namespace {

using nlohmann::json;

json material(const OpenPbrParameters& parameters) {
  const std::string file = gltf_binary(parameters, "paint");
  EXPECT_EQ(file.substr(0, 4), "glTF");
  const std::size_t size =
      static_cast<unsigned char>(file[12]) + (std::size_t{static_cast<unsigned char>(file[13])} << 8);
  const json document = json::parse(file.substr(20, size));
  // what is used is named, and nothing else
  json named = json::array(), entry = document["materials"][0];
  if (entry.contains("extensions"))
    for (const auto& [name, value] : entry["extensions"].items()) named.push_back(name);
  EXPECT_EQ(document.value("extensionsUsed", json::array()), named);
  return entry;
}

TEST(GltfBinary, HasNoExtensionThatDoesNothing) {
  EXPECT_FALSE(material({}).contains("extensions"));
}

TEST(GltfBinary, HasAnExtensionForEachLayerOfOpenPbr) {
  OpenPbrParameters p;
  p.specular_ior = 1.8;
  p.specular_color = {1, 0.5, 0.5};
  p.specular_roughness_anisotropy = 0.5;
  p.coat_weight = 0.5;
  p.coat_ior = 1.5;
  p.coat_color = {1, 0, 1};
  p.coat_roughness = 0.1;
  p.fuzz_weight = 0.5;
  p.fuzz_color = {1, 0.5, 0};
  p.thin_film_weight = 0.25;
  p.thin_film_thickness = 0.5;
  const json entry = material(p), &found = entry["extensions"];
  EXPECT_EQ(found["KHR_materials_ior"]["ior"], 1.8);
  EXPECT_EQ(found["KHR_materials_specular"]["specularColorFactor"], json({1, 0.5, 0.5}));
  EXPECT_EQ(found["KHR_materials_sheen"]["sheenColorFactor"], json({0.5, 0.25, 0}));
  EXPECT_EQ(found["KHR_materials_iridescence"]["iridescenceThicknessMaximum"], 500);  // nanometres
  EXPECT_NEAR(found["KHR_materials_clearcoat"]["clearcoatFactor"].get<double>(), 0.5, 1e-12);
  const json color = entry["pbrMetallicRoughness"]["baseColorFactor"];
  EXPECT_DOUBLE_EQ(color[0].get<double>(), 0.8);
  EXPECT_DOUBLE_EQ(color[1].get<double>(), 0.4);  // half of it under a coat that lets no green through
}

TEST(GltfBinary, HasOpenPbrsAlphas) {
  const MetallicRoughness core{{0.9, 0.5, 0.1}, 1, 0.4, 0.6, false};
  const json entry = material(openpbr_of(core));
  EXPECT_NEAR(entry["pbrMetallicRoughness"]["roughnessFactor"].get<double>(), core.roughness, 1e-9);
  EXPECT_NEAR(entry["extensions"]["KHR_materials_anisotropy"]["anisotropyStrength"].get<double>(),
              core.anisotropy, 1e-9);
}

}  // namespace
}  // namespace burnish
