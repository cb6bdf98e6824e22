// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/render/scene.h>

namespace burnish {

CameraFrame frame_of(const Camera& camera) noexcept {
  const Vec3 back = normalize(camera.eye - camera.target);
  const Vec3 right = orthogonalized(cross(camera.up, back), back);
  return {right, cross(back, right), back};
}

void fit_to_unit_sphere(std::span<MeshPart> parts) {
  const Vec3 middle = bounds_of(parts).middle();
  double farthest = 0;
  for (const MeshPart& part : parts)
    for (const Vertex& v : part.mesh.vertices)
      farthest = std::max(farthest, length(to_vec3(v.position) - middle));
  const double scale = farthest > 0 ? 1 / farthest : 1;
  for (MeshPart& part : parts)
    for (Vertex& v : part.mesh.vertices) v.position = to_floats(scale * (to_vec3(v.position) - middle));
}

Camera camera_for_unit_sphere(double yaw, double pitch) noexcept {
  constexpr double kSpare = 1.04;
  Camera camera;
  camera.eye = kSpare / std::sin(0.5 * camera.field_of_view) *
               Vec3{std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
  return camera;
}

void check_scene(const Scene& scene, int width, int height, std::size_t materials) {
  constexpr int kMaxSide = 16384;
  if (std::min(width, height) < 1 || std::max(width, height) > kMaxSide)
    throw Error(fmt::format("scene: expected a picture of 1 to {} pixels a side, found {} x {}", kMaxSide,
                            width, height));
  const Camera& camera = scene.camera;
  if (!(length(camera.eye - camera.target) > 0))
    throw Error("scene: expected a camera that is away from its target, found it there");
  if (!(camera.field_of_view > 0 && camera.field_of_view < kPi))
    throw Error(fmt::format("scene: expected a field of view in (0, pi), found {}", camera.field_of_view));
  for (const MeshPart& part : scene.parts) {
    if (part.material < 0 || static_cast<std::size_t>(part.material) >= materials)
      throw Error(fmt::format("scene: expected a material below {}, found {}", materials, part.material));
    for (const auto& triangle : part.mesh.triangles)
      if (std::ranges::max(triangle) >= part.mesh.vertices.size())
        throw Error(fmt::format("scene: expected corners below {}, found {}", part.mesh.vertices.size(),
                                std::ranges::max(triangle)));
  }
}

Image averaged(const Image& image, int factor) {
  if (factor < 1 || image.width % factor != 0 || image.height % factor != 0)
    throw Error(fmt::format("picture: expected sides that are multiples of {}, found {} x {}", factor,
                            image.width, image.height));
  Image result(image.width / factor, image.height / factor, image.channels);
  const float share = 1.0f / static_cast<float>(factor * factor);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (std::size_t c = 0; c < image.channels; ++c)
        result.at(x / factor, y / factor)[c] += share * image.at(x, y)[c];
  return result;
}

}  // namespace burnish
