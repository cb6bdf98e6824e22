#pragma once

#include <string>

#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/metallic_roughness.h>

namespace burnish {

/// A USD layer, text: a sphere NAME with a material whose MaterialX surface is one open_pbr_surface node, and
/// whose universal surface a UsdPreviewSurface with its base, coat and index of refraction: without film, fuzz,
/// anisotropy and the colours of highlights. Throws Error for a name that check_shader_name refuses. Source:
/// [UsdPreviewSurface 2021], [MaterialX 2024].
std::string usda_layer(const OpenPbrParameters& parameters, const std::string& name);

/// OpenPBR with the core material's alphas and reflectance at normal incidence; without its anisotropy where
/// that is across the tangent.
OpenPbrParameters openpbr_of(const MetallicRoughness& core) noexcept;

}  // namespace burnish
