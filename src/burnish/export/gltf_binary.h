#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <burnish/factors/factored_brdf.h>
#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/metallic_roughness.h>

namespace burnish {

/// A glTF 2.0 file (GLB): a sphere with tangents whose material is `core`, and whose extension
/// BURNISH_materials_factored holds the factors.
std::string gltf_binary(const FactoredBrdf& brdf, const MetallicRoughness& core, const std::string& name);

/// The same with the nearest that glTF has to OpenPBR: the core material with KHR_materials_ior, _specular,
/// _anisotropy, _clearcoat, _sheen and _iridescence, those of them that do something. Roughness and anisotropy
/// are exact, the coat's reflectance at normal incidence is that of its index of refraction up to 0.04, its
/// colour goes to the base; lost are the diffuse base's roughness and the coat's anisotropy and
/// darkening. Source: [glTF 2021], [OpenPBR 2024].
std::string gltf_binary(const OpenPbrParameters& parameters, const std::string& name);

/// That material as JSON of glTF's, without its name.
nlohmann::json gltf_material(const OpenPbrParameters& parameters);

}  // namespace burnish
