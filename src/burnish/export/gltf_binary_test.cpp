#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/export/gltf_binary.h>

namespace burnish {
namespace {

using nlohmann::json;

json material(const OpenPbrParameters& parameters) {
  const std::string file = gltf_binary(gltf_material(parameters), "paint");
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
  p.specular_ior = 2;
  p.specular_color = {1, 0.5, 0.5};
  p.specular_roughness_anisotropy = 0.5;
  p.coat_weight = 0.5;
  p.coat_ior = 1.5;
  p.coat_color = {1, 0, 1};
  p.coat_darkening = 0;
  p.fuzz_weight = 0.5;
  p.fuzz_color = {1, 0.5, 0};
  p.thin_film_weight = 0.25;
  p.thin_film_thickness = 0.5;
  const json entry = material(p), &found = entry["extensions"];
  EXPECT_NEAR(found["KHR_materials_ior"]["ior"].get<double>(), (2 + 2 / 1.5) / 2,
              1e-12);  // half of it coated
  EXPECT_EQ(found["KHR_materials_specular"]["specularColorFactor"], json({1, 0.5, 0.5}));
  EXPECT_EQ(found["KHR_materials_sheen"]["sheenColorFactor"], json({0.5, 0.25, 0}));
  EXPECT_EQ(found["KHR_materials_iridescence"]["iridescenceThicknessMaximum"], 500);  // nanometres
  EXPECT_NEAR(found["KHR_materials_clearcoat"]["clearcoatFactor"].get<double>(), 0.5, 1e-12);
  const json color = entry["pbrMetallicRoughness"]["baseColorFactor"];
  EXPECT_DOUBLE_EQ(color[0].get<double>(), 0.8);
  EXPECT_DOUBLE_EQ(color[1].get<double>(), 0.4);  // half of it under a coat that lets no green through
}

// alpha^2 of the core material across, and mix(alpha, 1, strength^2) along: OpenPBR's, eq. of its roughness.
TEST(GltfBinary, GivesTheBaseWhatACoatDoesToIt) {
  OpenPbrParameters p;
  p.specular_roughness = 0.3;
  p.coat_weight = 1;
  p.coat_roughness = 0.4;
  const json coated = material(p)["pbrMetallicRoughness"];
  EXPECT_NEAR(std::pow(coated["roughnessFactor"].get<double>(), 4), std::pow(0.3, 4) + 2 * std::pow(0.4, 4),
              1e-12);
  EXPECT_LT(coated["baseColorFactor"][0], 0.8);
  p.coat_darkening = 0;
  EXPECT_DOUBLE_EQ(material(p)["pbrMetallicRoughness"]["baseColorFactor"][0].get<double>(), 0.8);
}

TEST(GltfBinary, HasOpenPbrsAlphas) {
  for (const double anisotropy : {0.0, 0.2, 0.7, 1.0})
    for (const double roughness : {0.0, 0.3, 0.8}) {
      OpenPbrParameters p;
      p.specular_roughness = roughness;
      p.specular_roughness_anisotropy = anisotropy;
      const double across = 1 - anisotropy,
                   alpha_x = roughness * roughness * std::sqrt(2 / (1 + across * across));
      const json entry = material(p);
      const double alpha = std::pow(entry["pbrMetallicRoughness"]["roughnessFactor"].get<double>(), 2);
      const double strength =
          entry.value("/extensions/KHR_materials_anisotropy/anisotropyStrength"_json_pointer, 0.0);
      EXPECT_NEAR(alpha, across * alpha_x, 1e-12);
      EXPECT_NEAR(alpha + (1 - alpha) * strength * strength, alpha_x, 1e-12);
    }
}

}  // namespace
}  // namespace burnish
