// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// The functions of generate_shader(FactoredBrdf) for OpenPBR: its formulas, without textures. Parameters are
/// constants, and layers of weight 0 cost nothing. The cost counts exp2, acos and cos as powers. Error, beside
/// OpenPbr::eval of the same floats: 1e-3 relative for 99.9 % of pairs of directions, half of them in highlights, of
/// roughness 0.02 and above. Throws Error for a name that is none.
Shader generate_shader(const OpenPbr& material, ShaderLanguage language, const std::string& name);

}  // namespace burnish
