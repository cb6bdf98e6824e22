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

/// Smooth noise that repeats with the surface: `cells` bumps along each side, and two octaves above.
struct NoiseMap {
  int cells = 4;
  std::uint64_t seed = 1;
};

/// A surface made of materials, and how pictures of it are taken.
struct SurfaceScene {
  int width = 0, height = 0;
  double size_x = 1, size_y = 1;
  std::vector<Source> materials;
  /// Shares of the materials, [material][row][x], which add up to 1 in every texel.
  std::vector<std::vector<float>> shares;
  std::vector<float> heights;  ///< [row][x], in the unit of `size`; the surface repeats
  std::vector<Station> lights, views;
  double noise = 0;            ///< sigma of the log-normal noise of every value
  std::optional<double> clip;  ///< what values end at
  bool shadows = true;         ///< of heights, and what heights hide from a view
  double misregistered = 0;    ///< share of the pictures that are one texel off, to any of four sides
  int held_out = 0;            ///< every so many pictures are held out; 0: none
  bool give_normals = true;    ///< whether the capture says what its normals are
  std::uint64_t seed = 1;
};

/// Reads a scene; docs/guide/surfaces.md lists its members. Materials are BRDF arguments; files are named from the
/// scene's folder. Throws Error, naming file and member.
SurfaceScene parse_surface_scene(const FileBytes& file, const std::filesystem::path& folder);

/// The normal of a texel, by differences of its neighbours' heights.
Vec3 scene_normal(const SurfaceScene& scene, int x, int y) noexcept;

/// Shares of the materials at a texel times their values, reciprocal parts of what was measured, under the texel's
/// normal, f cos(theta_i) a channel, without shadows, noise and clipping. wi and wo are unit vectors of the surface's
/// frame.
std::array<double, 3> scene_radiance(const SurfaceScene& scene, int x, int y, Vec3 wi, Vec3 wo);

/// Takes the pictures: a folder with capture.json, halves without compression, one picture for each light and view,
/// masks of what is in shadow or hidden for those held out, and normals. Pictures are made side by side, a few in
/// memory at a time; capture.json is written last. The same bytes for any number of threads. Returns what it says.
/// Throws Error if a material has other than one or three channels or the folder cannot be written.
CaptureForm write_virtual_capture(const SurfaceScene& scene, const std::filesystem::path& folder,
                                  const std::function<void(double fraction)>& progress = nullptr);

}  // namespace burnish
