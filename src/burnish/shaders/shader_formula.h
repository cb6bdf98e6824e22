// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/formula/expression.h>
#include <burnish/shaders/frame_function.h>
#include <burnish/shaders/shader.h>
#include <burnish/shaders/texture_packing.h>

namespace burnish {

/// The formula that generate_shader writes, as an expression over the vectors wi and wo, above the horizon, and
/// texels of the textures: a number or a vector. Volumes stand behind the layers of `before`. Throws Error as
/// generate_shader does.
struct ShaderFormula {
  Expr value;
  std::vector<Expr> lobes;  ///< whose sum it is
  std::vector<ShaderTexture> textures;
};
ShaderFormula shader_formula(const FactoredBrdf& brdf, const ShaderOptions& options,
                             const LayersBefore* before = nullptr);

/// Every lobe of a model apart: functions `vec3 NAME(vec3 wi, vec3 wo)` as generate_shader writes them, over
/// textures that they share.
struct LobeFunctions {
  std::string text;  ///< declarations and functions, after the language's header
  std::vector<std::string> names;
  std::vector<ShaderTexture> textures;
};
LobeFunctions lobe_functions(const FactoredBrdf& brdf, const ShaderOptions& options,
                             const LayersBefore* before = nullptr);

/// The surroundings of a formula's function: a language's header with the declarations of textures, and the
/// parameters besides the directions that read them.
struct FormulaSurroundings {
  std::string declarations;
  MoreParameters more;
};
FormulaSurroundings formula_surroundings(const ShaderOptions& options,
                                         const std::vector<ShaderTexture>& textures);

/// A function `vec3 NAME(vec3 wi, vec3 wo, ...)` that returns a formula's value, zero below the horizon.
struct FormulaFunction {
  std::string text;
  ShaderCost cost;
};
FormulaFunction formula_function(const Expr& value, const ShaderOptions& options, const std::string& name,
                                 const MoreParameters& more, std::size_t textures);

/// A formula as split_shader parts it. Throws Error as split_shader does.
SplitShader split_formula(ShaderFormula formula, const ShaderOptions& options);

}  // namespace burnish
