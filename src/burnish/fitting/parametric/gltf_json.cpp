// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include <burnish/fitting/parametric/gltf_json.h>

namespace burnish {

nlohmann::ordered_json gltf_json(const GltfMaterial& m) {
  using Json = nlohmann::ordered_json;
  const GltfMaterial neutral;
  const auto color = [](Rgb c) { return Json{c.r, c.g, c.b}; };
  Json json{{"pbrMetallicRoughness",
             {{"baseColorFactor", {m.base_color.r, m.base_color.g, m.base_color.b, 1}},
              {"metallicFactor", m.metallic},
              {"roughnessFactor", m.roughness}}}};
  const auto add = [&](const char* name, bool seen, Json extension) {
    if (seen) json["extensions"][std::string("KHR_materials_") + name] = std::move(extension);
  };
  add("ior", m.ior != neutral.ior, {{"ior", m.ior}});
  add("specular", m.specular != neutral.specular || m.specular_color != neutral.specular_color,
      {{"specularFactor", m.specular}, {"specularColorFactor", color(m.specular_color)}});
  add("anisotropy", m.anisotropy > 0,
      {{"anisotropyStrength", m.anisotropy}, {"anisotropyRotation", m.rotation}});
  add("iridescence", m.iridescence > 0,
      {{"iridescenceFactor", m.iridescence},
       {"iridescenceIor", m.iridescence_ior},
       {"iridescenceThicknessMaximum", m.iridescence_thickness}});
  add("sheen", m.sheen_color != neutral.sheen_color,
      {{"sheenColorFactor", color(m.sheen_color)}, {"sheenRoughnessFactor", m.sheen_roughness}});
  add("clearcoat", m.clearcoat > 0,
      {{"clearcoatFactor", m.clearcoat}, {"clearcoatRoughnessFactor", m.clearcoat_roughness}});
  return json;
}

}  // namespace burnish
