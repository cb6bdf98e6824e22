// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <burnish/render/gl/surface_shader.h>
#include <burnish/render/scene.h>

namespace burnish {

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

  /// Draws so many frames one after the other and waits until they are done.
  void draw(int frames = 1) const;
  /// The frame drawn last: three channels, linear.
  Image read() const;

  static constexpr int kLightsAPass = 512;

 private:
  struct State;
  void draw_frame() const;
  GlRenderer(const Scene& scene, std::span<const SurfaceShader> materials,
             std::span<const std::vector<Rgb>> vertex_values, int width, int height);
  std::unique_ptr<State> state_;
};

}  // namespace burnish
