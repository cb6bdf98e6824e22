// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/math/vec3.h>

namespace burnish {

/// A corner of triangles, as it goes to a GPU: single precision, nothing packed.
struct Vertex {
  std::array<float, 3> position{};
  std::array<float, 3> normal{};   ///< unit
  std::array<float, 3> tangent{};  ///< unit, orthogonal to the normal
  float side = 1;                  ///< the frame's third axis is side * cross(normal, tangent); 1 or -1
  std::array<float, 2> uv{};       ///< v upwards

  friend bool operator==(const Vertex&, const Vertex&) = default;
};

/// Triangles with a tangent frame at every vertex. Seen from outside, corners run counterclockwise.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Part of a scene: a mesh and which of the scene's materials it has.
struct MeshPart {
  Mesh mesh;
  int material = 0;
};

/// The smallest box around all vertices.
struct Bounds {
  Vec3 low, high;

  Vec3 middle() const noexcept { return 0.5 * (low + high); }
  double radius() const noexcept { return 0.5 * length(high - low); }
};

/// Throws Error if there is no vertex.
Bounds bounds_of(std::span<const MeshPart> parts);

inline Vec3 to_vec3(const std::array<float, 3>& v) noexcept {
  return {v[0], v[1], v[2]};
}
inline std::array<float, 3> to_floats(Vec3 v) noexcept {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// w made orthogonal to the unit vector n and normalized; where nothing is left, any direction that is
/// orthogonal to n.
Vec3 orthogonalized(Vec3 w, Vec3 n) noexcept;

/// The tangent of meshes that say nothing about theirs: around the vertical axis, normalize(y x n), as
/// metrics/sphere_images.h has it.
Vec3 tangent_around_y(Vec3 n) noexcept;

}  // namespace burnish
