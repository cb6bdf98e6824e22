#pragma once

#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// The functions of generate_shader(FactoredBrdf) for OpenPBR: its formulas, without textures. Parameters are constants,
/// and layers of weight 0 cost nothing. The cost counts exp2, acos and cos as powers. Throws Error for a name that is
/// none.
Shader generate_shader(const OpenPbr& material, ShaderLanguage language, const std::string& name);

}  // namespace burnish
