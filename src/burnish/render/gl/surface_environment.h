// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <burnish/render/gl/gl_renderer.h>
#include <burnish/render/light/environment_light.h>
#include <burnish/render/light/image_based_light.h>
#include <burnish/render/light/tapped_light.h>

namespace burnish {

/// Shader text for the light that a surface reflects of one environment.
struct LightShader {
  std::string function;                ///< vec3 of vec3 arguments, radiance towards v
  std::vector<std::string> arguments;  ///< n, v or n, t, s, v: unit vectors of the world, y up
  std::string text;                    ///< no #version line
  std::vector<GlTexture> textures;     ///< all of them filtered
};

/// The light of an environment that a factored BRDF reflects, by prefilter where it is isotropic, by tap and blur
/// where it is not.
class SurfaceLight {
 public:
  /// Takes a second or two. Throws Error as prefilter or tap do.
  SurfaceLight(const FactoredBrdf& brdf, const Environment& environment);

  /// Filtered reads of one evaluation.
  int fetches() const noexcept;
  /// `burnish_NAME_light` in GLSL 4.50 or ES 3.00. Throws Error for other languages and as generate_shader
  /// does.
  LightShader shader(ShaderLanguage language, const std::string& name) const;

 private:
  std::variant<ImageBasedLight, std::pair<TappedBrdf, BlurredEnvironment>> light_;
};

/// Adds the light of an environment to a surface's shader. Throws Error as SurfaceLight does.
void add_environment(SurfaceShader& surface, const FactoredBrdf& brdf, const Environment& environment);

}  // namespace burnish
