#pragma once

#include <string>

#include <burnish/factors/factored_brdf.h>
#include <burnish/fitting/parametric/metallic_roughness_fit.h>

namespace burnish {

struct GltfBinary {
  std::string bytes;
  MetallicRoughnessFit core;  ///< its material
};

/// A glTF 2.0 file (GLB): a sphere with tangents whose material is the core one that looks most like the
/// model, and whose extension BURNISH_materials_factored holds the factors. Throws Error for other than 1 or
/// 3 channels.
GltfBinary gltf_binary(const FactoredBrdf& brdf, const std::string& name);

}  // namespace burnish
