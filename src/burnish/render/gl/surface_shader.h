// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/render/gl/gl_objects.h>
#include <burnish/shaders/shader.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// A reflectance in GLSL 4.50. Its variables must not start with "burnish_".
struct SurfaceShader {
  std::string declarations;  ///< of functions and samplers
  std::string view;          ///< statements, once a pixel: have vec3 wo, above the horizon
  std::string light;         ///< statements, for every light above the horizon: have vec3 wi too
  std::string value;         ///< expression of f_r, vec3, in 1/sr
  std::vector<GlTexture> textures;
  /// Expression of the radiance that is reflected of light from all around, vec3, or empty: has the vec3
  /// burnish_n, burnish_t, burnish_s, burnish_v, unit vectors of the world: normal, tangent, s at right
  /// angles, to the viewer.
  std::string environment{};
  /// Statements, once a pixel, before directions are found: have floats u, v (downwards) and lod, and may turn
  /// burnish_n, burnish_t, burnish_s.
  std::string place{};
  std::vector<MapTexture> maps{};
};

/// Makes the shader of a factored BRDF; textures have `precision`. Throws Error as split_shader.
SurfaceShader surface_shader(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision);

/// Makes the shader of a surface, drawn over the meshes' texture coordinates. Throws Error as split_shader.
SurfaceShader surface_shader(const SpatialBrdf& surface, ShaderFilter filter, TableFormat precision);

/// GlRenderer's programs, without #version lines. Vertices have place, normal, tangent, side, a value and texture
/// coordinates at locations 0 to 5; `burnish_projection` takes places to the screen.
std::string scene_vertex_shader();
/// Shows the values of vertices.
std::string interpolated_fragment_shader();
/// Light of a buffer of points (binding 0, `burnish_light_count` of them) and, where `burnish_first` is set,
/// from all around, that the surface reflects towards `burnish_eye`.
std::string scene_fragment_shader(const SurfaceShader& surface);

}  // namespace burnish
