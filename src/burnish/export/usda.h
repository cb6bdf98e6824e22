#pragma once

#include <string>

#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/metallic_roughness.h>

namespace burnish {

/// A USD layer, text: a sphere NAME with a material whose surface is a UsdPreviewSurface of the core material,
/// and whose MaterialX surface is that of NAME.mtlx beside it, by reference. Throws Error for a name that
/// check_shader_name refuses. Source: [UsdPreviewSurface 2021].
std::string usda_layer(const MetallicRoughness& preview, const std::string& name);

/// The same of OpenPBR: the preview has metal, coat and index of refraction of it, without film, fuzz,
/// anisotropy and the colours of highlights; the MaterialX surface is in the layer itself.
std::string usda_layer(const OpenPbrParameters& parameters, const std::string& name);

}  // namespace burnish
