// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <variant>
#include <vector>

#include <burnish/reflectance/brdf.h>
#include <burnish/render/light/environment_light.h>
#include <burnish/render/scene.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

struct CpuOptions {
  int width = 512, height = 512;
  bool shadows = false;  ///< whether triangles keep the light of points from others
  /// Light from all around, without shadows, or null: radiance_in_environment with this many draws, a square,
  /// and as many of every lamp.
  const Environment* environment = nullptr;
  int draws = 64;
};

/// A picture of a scene by ray casting in double precision, the reference for GlRenderer: three channels,
/// linear. `materials` have one or three channels; directions that one does not know are black. The same bits
/// for every number of threads. Throws Error as check_scene, for materials of other channels and for draws
/// that are not the square of 1 to 1024.
Image render_cpu(const Scene& scene, std::span<const BrdfRef> materials, const CpuOptions& options);

/// A material of a scene: the same everywhere, or a surface, not null, over the meshes' texture coordinates.
using SceneMaterial = std::variant<BrdfRef, const SpatialBrdf*>;

/// The same with surfaces among the materials. A surface's level of detail is log2 of the larger of a pixel's steps along
/// columns and rows, in texels; light from all around is drawn by a lobe like its mean over the texels.
Image render_cpu(const Scene& scene, std::span<const SceneMaterial> materials, const CpuOptions& options);

/// Returns the values of render_cpu at vertices, without shadows: for every part, in order, a value a vertex.
std::vector<std::vector<Rgb>> shade_vertices(const Scene& scene, std::span<const BrdfRef> materials);

/// One flag a pixel: 1 where the ray through it and those to its eight neighbours hit the same part, with
/// normals that lie less than 30 degrees apart: away from outlines, where two renderers may see different
/// triangles.
std::vector<std::uint8_t> interior_pixels(const Scene& scene, int width, int height);

}  // namespace burnish
