// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/source.h>

namespace burnish {

/// Smooth noise that repeats with the surface: `cells` bumps along each side, and two finer octaves.
struct NoiseMap {
  int cells = 4;
  std::uint64_t seed = 1;
};

/// A surface made of materials, and the setup that takes pictures of it.
struct SurfaceScene {
  int width = 0, height = 0;
  double size_x = 1, size_y = 1;
  std::vector<Source> materials;
  /// Shares of the materials, [material][row][x], which add up to 1 in every texel.
  std::vector<std::vector<float>> shares;
  std::vector<float> heights;  ///< [row][x], in the unit of `size`; the surface repeats
  std::vector<Station> lights, views;
  double noise = 0;            ///< sigma of the log-normal noise of every value
  std::optional<double> clip;  ///< values end at this one
  bool shadows = true;         ///< heights cast shadows and hide texels from a view
  double misregistered = 0;    ///< share of the pictures that are shifted by one texel, to any of four sides
  int held_out = 0;            ///< one of so many pictures is held out; 0: none
  bool give_normals = true;    ///< true if the capture has its normals
  std::uint64_t seed = 1;
};

/// Reads a scene; docs/guide/surfaces.md lists its members. Materials are BRDF arguments; files are relative to the
/// scene's folder. Throws Error with file and member.
SurfaceScene parse_surface_scene(const FileBytes& file, const std::filesystem::path& folder);

/// Returns the normal of a texel, from differences of its neighbours' heights.
Vec3 scene_normal(const SurfaceScene& scene, int x, int y) noexcept;

/// Returns f cos(theta_i) of a texel, a value a channel, without shadows, noise and clipping: the sum of the
/// materials' values under the texel's normal, times their shares. Measured materials contribute their reciprocal
/// part. wi and wo are unit vectors of the surface's frame.
std::array<double, 3> scene_radiance(const SurfaceScene& scene, int x, int y, Vec3 wi, Vec3 wo);

/// Takes the pictures and returns the form that capture.json holds. The folder gets capture.json, one picture for
/// each light and view (halves without compression), normals, and for held-out pictures masks of texels in shadow or
/// hidden. Pictures are made in parallel, a few in memory at a time; capture.json is written last. The bytes are the
/// same for any number of threads. Throws Error if a material has other than one or three channels or the folder
/// cannot be written.
CaptureForm write_virtual_capture(const SurfaceScene& scene, const std::filesystem::path& folder,
                                  const std::function<void(double fraction)>& progress = nullptr);

}  // namespace burnish
