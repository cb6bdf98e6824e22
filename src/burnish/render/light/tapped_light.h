// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/render/light/filtered_environment.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// A direction that stands for the ones around it: a half vector, or one to the light.
struct LightTap {
  Vec3 direction;    ///< of the local frame, unit
  double area = 0;   ///< what the value there is multiplied with, sr; may be negative
  double width = 0;  ///< of the blur about it, radians
};

/// A lobe with the directions where the light under it is read.
struct TappedLobe {
  FactoredBrdf outside, inside;  ///< factors of the view alone, with the scale; the others
  bool of_half = true;           ///< taps are half vectors
  std::vector<LightTap> taps;
};

/// Any factored BRDF, anisotropic ones too, under a blurred environment: each lobe's integral is a sum over
/// taps, where the environment is read as wide as the part of the lobe that the tap stands for
/// [Krivanek 2008, with parts found beforehand instead of samples drawn].
struct TappedBrdf {
  std::vector<TappedLobe> lobes;

  /// Filtered reads of one evaluation at most: for every tap the environment and the tables of `inside`.
  int fetches() const noexcept;
  /// Radiance towards v, unit; 0 where n·v <= 0.
  Rgb radiance(const BlurredEnvironment& environment, const LightFrame& frame, Vec3 v) const noexcept;
};

/// Parts of a lobe are clusters of half vectors (of directions to the light where no factor depends on both
/// directions alike), round and dense where the lobe is high [Lloyd 1982]; areas are those whose blurs add up
/// to the lobe, by least squares. Throws Error unless `taps` is in [1, 256] and the BRDF has 1 or 3 channels.
TappedBrdf tap(const FactoredBrdf& brdf, int taps = 96);

/// Shader text of a TappedBrdf.
struct TappedShader {
  std::string text;  ///< no #version line
  /// A 3-D one with the blurred environment, linear and clamped, with volumes behind it; and at most one 2-D one.
  std::vector<ShaderTexture> textures;
};

/// `vec3 burnish_NAME_light(vec3 n, vec3 t, vec3 s, vec3 v)`: TappedBrdf::radiance in GLSL 4.50 or ES 3.00.
/// Throws Error for other languages and as generate_shader does.
TappedShader generate_shader(const TappedBrdf& brdf, const BlurredEnvironment& environment,
                             ShaderLanguage language, const std::string& name);

}  // namespace burnish
