#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <burnish/factors/factored_brdf.h>
#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/metallic_roughness.h>

namespace burnish {

/// A glTF 2.0 file (GLB): a sphere with tangents whose material is `material`, as gltf_material makes it, and
/// whose extension BURNISH_materials_factored holds the factors.
std::string gltf_binary(const FactoredBrdf& brdf, nlohmann::json material, const std::string& name);

/// The same without factors.
std::string gltf_binary(nlohmann::json material, const std::string& name);

/// A core material as JSON of glTF's, without a name, with KHR_materials_anisotropy where it has a grain.
nlohmann::json gltf_material(const MetallicRoughness& core);

/// The nearest that glTF has to OpenPBR: the core material with KHR_materials_ior, _specular, _anisotropy,
/// _clearcoat, _sheen and _iridescence, those of them that do something. Alphas of the base are exact, the
/// coat's reflectance at normal incidence is that of its index of refraction up to 0.04; its colour, its
/// darkening and what it does to the base's roughness and index go to the base. Lost are the diffuse base's
/// roughness and the coat's anisotropy. Source: [glTF 2021], [OpenPBR 2024].
nlohmann::json gltf_material(const OpenPbrParameters& parameters);

}  // namespace burnish
