#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/render/gl_objects.h>
#include <burnish/render/scene.h>
#include <burnish/shaders/shader.h>

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
};

/// Of a factored BRDF; textures of `precision`. Throws Error as split_shader.
SurfaceShader surface_shader(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision);

/// Draws a scene into a float picture by OpenGL. Needs a GlContext that is current, for as long as it lives.
/// Lights are read from a uniform buffer, as many as it holds at a time, any number in all.
class GlRenderer {
 public:
  /// Throws Error as check_scene and upload_texture, and if the driver refuses a shader or a picture so
  /// large.
  GlRenderer(const Scene& scene, std::span<const SurfaceShader> materials, int width, int height);
  /// Radiance given at vertices and interpolated, as shade_vertices makes it [Gouraud 1971].
  GlRenderer(const Scene& scene, std::span<const std::vector<Rgb>> vertex_values, int width, int height);
  ~GlRenderer();
  GlRenderer(const GlRenderer&) = delete;
  GlRenderer& operator=(const GlRenderer&) = delete;

  /// Draws one frame and waits until it is done.
  void draw() const;
  /// The frame drawn last: three channels, linear.
  Image read() const;

  static constexpr int kLightsAPass = 512;

 private:
  struct State;
  GlRenderer(const Scene& scene, std::span<const SurfaceShader> materials,
             std::span<const std::vector<Rgb>> vertex_values, int width, int height);
  std::unique_ptr<State> state_;
};

}  // namespace burnish
