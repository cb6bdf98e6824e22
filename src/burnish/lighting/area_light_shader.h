#pragma once

#include <string>

#include <burnish/lighting/area_light_table.h>
#include <burnish/shaders/shader.h>

namespace burnish {

struct AreaLightShader {
  std::string text;       ///< no #version line
  ShaderTexture texture;  ///< RGB, half; linear, clamped to the edge
  ShaderCost cost;        ///< of the function in the local frame
};

/// Source text of reflected() for a quadrilateral, in floats:
/// - `burnish_NAME_quad(wo, p0, p1, p2, p3)`: what a convex, planar quadrilateral of radiance 1 makes the surface reflect
///   towards wo, unit; corners in order, relative to the point that is lit, all of the local frame;
/// - `burnish_NAME_quad_world(n, t, v, p0, p1, p2, p3)`: the same in any frame, with corners relative to the point too.
/// Within 1e-4 of the table's albedo, and of its texture's rounding to half precision. The texture takes binding 8 in
/// HLSL (t8) and its pair in WGSL, so that it stands beside those of generate_shader; with `places`, the 8 is counted
/// from the binding there. Throws Error for cpp, which has no textures, for a name that is none of generate_shader's,
/// and for places below 0.
AreaLightShader generate_shader(const AreaLightTable& table, ShaderLanguage language, const std::string& name,
                                const ShaderPlaces& places = {});

}  // namespace burnish
