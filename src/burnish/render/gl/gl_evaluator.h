// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/render/gl/gl_function.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// Evaluates a factored BRDF by its GLSL shader. Needs a GlContext that is current, for as long as it lives.
class GlEvaluator {
 public:
  /// `precision` is that of the textures: half or single. Throws Error if generate_shader does, for another
  /// precision, or as GlFunction does.
  GlEvaluator(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision);

  /// f_r in 1/sr, three values a pair: wi and wo, unit vectors of the local frame. At most
  /// GlFunction::kMaxCalls pairs.
  std::vector<float> eval(std::span<const GlVectors> pairs) const { return function_.call(pairs); }

 private:
  GlEvaluator(const Shader& shader, TableFormat precision, bool filtered);

  GlFunction function_;
};

/// Gives a shader its textures.
void set_textures(GlFunction& function, std::span<const ShaderTexture> textures, TableFormat precision,
                  bool filtered);

}  // namespace burnish
