// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/metallic_roughness.h>

namespace burnish {

/// A USD layer, text: a sphere NAME, a mesh with texture coordinates, with a material whose MaterialX surface is one open_pbr_surface node, and
/// whose universal surface a UsdPreviewSurface of a core material, without its anisotropy. Throws Error for a
/// name that check_shader_name refuses. Source: [UsdPreviewSurface 2021], [MaterialX 2024].
std::string usda_layer(const OpenPbrParameters& parameters, const MetallicRoughness& preview,
                       const std::string& name);

}  // namespace burnish
