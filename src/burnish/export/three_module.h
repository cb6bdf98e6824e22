#pragma once

#include <string>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// A JavaScript module that makes a ShaderMaterial of three.js, textures inside: web/three.js. Throws Error
/// as generate_shader does.
std::string three_module(const FactoredBrdf& brdf, const std::string& name);

}  // namespace burnish
