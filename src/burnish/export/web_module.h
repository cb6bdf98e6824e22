#pragma once

#include <string>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// JavaScript modules that make a ShaderMaterial of three.js or Babylon.js, textures inside: web/three.js and
/// web/babylon.js with the model. Throw Error as generate_shader does.
std::string three_module(const FactoredBrdf& brdf, const std::string& name);
std::string babylon_module(const FactoredBrdf& brdf, const std::string& name);

}  // namespace burnish
