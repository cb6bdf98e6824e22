// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <burnish/factors/factored_brdf.h>
#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/metallic_roughness.h>
#include <burnish/shaders/shader.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// JavaScript modules that make a ShaderMaterial of three.js or Babylon.js, textures inside: web/three.js and
/// web/babylon.js with the model. A surface brings its maps with their levels; OpenPBR has no textures. Modules of
/// three.js also make a node material (web/three_nodes.js), except for a surface; `core` reflects the light from all
/// around. Throw Error as generate_shader does.
std::string three_module(const FactoredBrdf& brdf, const MetallicRoughness& core, const std::string& name);
std::string three_module(const SpatialBrdf& surface, const std::string& name);
std::string three_module(const OpenPbr& material, const MetallicRoughness& core, const std::string& name);
std::string babylon_module(const FactoredBrdf& brdf, const std::string& name);
std::string babylon_module(const OpenPbr& material, const std::string& name);

/// Returns the JSON that scripts of web/ read of a surface: name, expression, shader, textures of the lobes, maps,
/// and whether places have a frame. Throws Error as generate_shader does.
nlohmann::json web_model(const SpatialBrdf& surface, const std::string& name);
/// The same of a shader without textures, whose model is called `expression`, and of OpenPBR.
nlohmann::json web_model(const Shader& shader, const std::string& expression, const std::string& name);
nlohmann::json web_model(const OpenPbr& material, const std::string& name);

}  // namespace burnish
