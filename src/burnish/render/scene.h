// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <burnish/image/image.h>
#include <burnish/math/rgb.h>
#include <burnish/render/mesh/mesh.h>

namespace burnish {

/// Light that leaves one point evenly in all directions.
struct PointLight {
  Vec3 position;
  Rgb intensity{1, 1, 1};  ///< per steradian: what arrives at distance r is intensity / r^2
};

/// A pinhole camera.
struct Camera {
  Vec3 eye{0, 0, 4}, target;
  Vec3 up{0, 1, 0};
  double field_of_view = 0.6;  ///< angle between the upper and the lower edge, radians, in (0, pi)
};

/// The scene of both renderers. They draw the outgoing radiance of [HomomorphicBrdf, eq. 2] without shadows, the sum
/// of f_r max(cos theta_i, 0) intensity / r^2 over the lights, at the middle of every pixel.
/// Normals and tangents are interpolated over triangles and normalized, and the tangent is made orthogonal to the
/// normal. Surfaces are seen from both sides, but give nothing where the view is below the interpolated horizon.
struct Scene {
  std::vector<MeshPart> parts;
  std::vector<PointLight> lights;
  Camera camera;
  Rgb background{0, 0, 0};
};

/// The camera's axes: unit vectors to the right, up and backwards.
struct CameraFrame {
  Vec3 right, up, back;
};
CameraFrame frame_of(const Camera& camera) noexcept;

/// Moves and scales the parts together so that the middle of their box is the origin and their farthest
/// vertex 1 away. Throws Error if there is none.
void fit_to_unit_sphere(std::span<MeshPart> parts);

/// A camera that has the unit sphere in its frame with little to spare, turned by `yaw` (radians, to the
/// right) and `pitch` (upwards) about the origin.
Camera camera_for_unit_sphere(double yaw, double pitch) noexcept;

/// Throws Error unless the picture's sides are in [1, 16384], the camera has a direction, the field of view
/// is in range, there are `materials` for the parts, and their triangles' corners exist.
void check_scene(const Scene& scene, int width, int height, std::size_t materials);

/// Averages squares of `factor` by `factor` pixels; sides must be multiples of factor >= 1, else throws
/// Error.
Image averaged(const Image& image, int factor);

}  // namespace burnish
