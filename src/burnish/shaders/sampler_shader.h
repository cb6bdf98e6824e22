// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/eval/tabulated_sampler.h>
#include <burnish/shaders/shader.h>

namespace burnish {

struct SamplerShader {
  std::string text;       ///< no #version line
  ShaderTexture texture;  ///< one channel of floats, read texel by texel; empty for cpp, which has arrays
  ShaderCost sample_cost, pdf_cost;  ///< costs of the functions in the local frame
};

/// Returns source text of TabulatedSampler in floats, over the sampler's own tables:
/// - `burnish_NAME_sample(wo, u)`: a direction to the light and, as fourth component, its density in 1/sr, drawn for
///   the unit vector wo by two uniform numbers of [0, 1). The density is 0 where the direction is not above the
///   horizon, and then the draw counts as no light;
/// - `burnish_NAME_pdf(wi, wo)`: the same density of any direction; 0 unless both are above the horizon;
/// - `burnish_NAME_sample_world(n, t, v, u)` and `burnish_NAME_pdf_world(n, t, l, v)`: the same in any frame.
/// Directions are within 1e-4 and densities within 1e-3 of the sampler's, but for draws that rounding moves across the
/// border of a cell. The texture takes binding 9 in HLSL (t9), GLSL and WGSL and its pair, 18, in Slang, so that it
/// stands beside those of generate_shader and of area lights. With `places`, the 9 is counted from the binding there.
/// Throws Error for a name that generate_shader does not accept, and for places below 0.
SamplerShader generate_shader(const SamplerTables& tables, ShaderLanguage language, const std::string& name,
                              const ShaderPlaces& places = {});

}  // namespace burnish
