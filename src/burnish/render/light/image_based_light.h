// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/render/gl/gl_function.h>
#include <burnish/render/light/environment_light.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// The resolution of the tabulated light.
struct PrefilterOptions {
  int slices = 16;    ///< polar angles of the view, evenly in tan(theta_o / 2) from 0 to 1; in [2, 64]
  int side = 32;      ///< texels along a hemisphere's map, in [8, 512]
  int harmonics = 4;  ///< orders of the azimuth about a kernel's axis, in [0, 4]
};

/// The light of an environment under one lobe, without the factors that depend on the view alone. The other factors
/// times cos(theta_i) are a kernel about an axis. The axis lies in the plane of view and normal, at `axis[slice]`
/// from the normal, away from the viewer: it is the mean direction of the kernel squared.
/// The kernel is a sum of cos(m psi) k_m(gamma), and where the BRDF is not its own mirror image also of sin(m psi)
/// l_m(gamma), in angle gamma and azimuth psi about that axis. So light from it is a sum of maps over the axis in the
/// world.
struct PrefilteredLobe {
  FactoredBrdf outside;      ///< one lobe: the factors of wo alone, with the scale and the maps'
  std::vector<double> axis;  ///< radians, one a slice
  /// Parabolic maps, RGB, whose largest magnitude is 1: [map][slice][y][x], x < side the hemisphere y >= 0 of
  /// the world, then the other, seen in a mirror that exchanges up and down; the outermost texels lie on the
  /// square around the horizon. Map 0 is the mean over psi; maps 2 m - 1 and 2 m go with cos and sin of m
  /// times the azimuth of the plane of view and normal about the axis.
  std::vector<float> maps;
};

/// Light reflected by an isotropic factored BRDF in one environment, for every normal and view.
struct ImageBasedLight {
  PrefilterOptions options;
  std::vector<PrefilteredLobe> lobes;

  int map_count() const noexcept { return 2 * options.harmonics + 1; }
  /// Every lobe's maps, one after another's.
  std::vector<float> joined_maps() const;
  /// Bytes of the maps as half floats, four channels.
  std::size_t bytes() const noexcept;
  /// Filtered reads of one evaluation: for every lobe its maps and its tables of the view.
  int fetches() const noexcept;
  /// Radiance towards v, unit, at normal n, unit: reads every map once, linear in all three directions. 0
  /// where n·v <= 0.
  Rgb radiance(Vec3 n, Vec3 v) const noexcept;
};

/// Tabulates p(wo) * integral of (the other factors) cos(theta_i) L(wi) for every lobe: p(wo) stays outside,
/// the rest is filtered before [Latta 2002], as [HomomorphicBrdf, sec. 7] proposes, with the kernel taken
/// whole, not as a product of separately filtered factors. Throws Error if the BRDF is anisotropic or has
/// other than 1 or 3 channels, and for options out of range.
ImageBasedLight prefilter(const FactoredBrdf& brdf, const Environment& environment,
                          const PrefilterOptions& options = {});

/// Shader text for one light.
struct ImageBasedShader {
  std::string text;  ///< no #version line
  /// Sampler of all lobes' maps, those of one after another's: 3-D, width 2 side, height side, depth lobes *
  /// maps * slices; linear, clamped.
  std::string maps;
  std::vector<ShaderTexture> tables;  ///< of all lobes' factors outside: one at most
};

/// `vec3 burnish_NAME_light(vec3 n, vec3 v)`: ImageBasedLight::radiance in GLSL 4.50 or ES 3.00, unit vectors
/// of the world's frame. Throws Error for other languages and as generate_shader does.
ImageBasedShader generate_shader(const ImageBasedLight& light, ShaderLanguage language,
                                 const std::string& name);

/// The shader on the OpenGL at hand. Needs a GlContext that is current, for as long as it lives.
class GlImageBasedLight {
 public:
  /// Maps and tables become half floats. Throws Error as GlFunction does.
  explicit GlImageBasedLight(const ImageBasedLight& light);

  /// Radiance at pairs of normal and view, three values a pair.
  std::vector<float> radiance(std::span<const GlVectors> pairs) const { return function_.call(pairs); }

 private:
  GlImageBasedLight(const ImageBasedLight& light, const ImageBasedShader& shader);

  GlFunction function_;
};

}  // namespace burnish
