// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <burnish/factors/factored_brdf.h>
#include <burnish/fitting/parametric/texel_materials.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// A glTF 2.0 file (GLB): a sphere with tangents whose material is `material`, as gltf_json makes it, and
/// whose extension BURNISH_materials_factored holds the factors.
std::string gltf_binary(const FactoredBrdf& brdf, nlohmann::json material, const std::string& name);

/// The same without factors.
std::string gltf_binary(nlohmann::json material, const std::string& name);

/// A square, its sides as the surface's width and height, with the textures of its texels' materials and normals.
std::string gltf_binary(const SpatialBrdf& surface, const TexelMaterials& materials, const std::string& name);

}  // namespace burnish
