#pragma once

#include <vector>

#include <burnish/formula/expression.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// What generate_shader writes, as an expression over the vectors wi and wo, above the horizon, and texels of
/// the textures: a number or a vector. Throws Error as it does.
struct ShaderFormula {
  Expr value;
  std::vector<ShaderTexture> textures;
};
ShaderFormula shader_formula(const FactoredBrdf& brdf, const ShaderOptions& options);

}  // namespace burnish
