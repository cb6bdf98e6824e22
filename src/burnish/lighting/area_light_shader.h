// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/lighting/area_light_table.h>
#include <burnish/shaders/shader.h>

namespace burnish {

struct AreaLightShader {
  std::string text;       ///< no #version line
  ShaderTexture texture;  ///< RGB, half; linear, clamped to the edge
  ShaderCost cost;        ///< cost of the function in the local frame
};

/// Returns source text of reflected() for a quadrilateral, in floats:
/// - `burnish_NAME_quad(wo, p0, p1, p2, p3)`: the radiance that the surface reflects towards the unit vector wo from
///   a convex, planar quadrilateral of radiance 1. Corners are in order and relative to the lit point; all vectors
///   are in the local frame;
/// - `burnish_NAME_quad_world(n, t, v, p0, p1, p2, p3)`: the same in any frame; corners are relative to the lit point
///   too.
/// The result is within 1e-4 of the table's albedo, plus the rounding of its texture to half precision. The texture
/// takes binding 8 in HLSL (t8) and its pair in WGSL, so that it stands beside those of generate_shader; with
/// `places`, the 8 is counted from the binding there. Throws Error for cpp, which has no textures, for a name that
/// generate_shader does not accept, and for places below 0.
AreaLightShader generate_shader(const AreaLightTable& table, ShaderLanguage language, const std::string& name,
                                const ShaderPlaces& places = {});

}  // namespace burnish
