#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <burnish/factors/factored_brdf.h>

namespace burnish::cli {

/// Texels of 1 or 3 channels as half floats, four channels, in base64: what WebGL2 filters without an
/// extension.
std::string half_texels(const std::vector<float>& values, int channels);
std::string base64(std::span<const std::byte> bytes);

/// A glTF 2.0 file (GLB): a sphere with tangents whose material is the core one that looks most like the
/// model, and whose extension BURNISH_materials_factored holds the factors. `manifest` gets the core material
/// and its PSNR. Throws Error for other than 1 or 3 channels.
std::string export_gltf(const FactoredBrdf& brdf, const std::string& name, nlohmann::json& manifest);

/// A JavaScript module that makes a ShaderMaterial of three.js, textures inside. Throws Error as
/// generate_shader does.
std::string export_three(const FactoredBrdf& brdf, const std::string& name);

}  // namespace burnish::cli
