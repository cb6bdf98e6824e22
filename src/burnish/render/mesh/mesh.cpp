// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <burnish/error.h>
#include <burnish/render/mesh/mesh.h>

namespace burnish {

Bounds bounds_of(std::span<const MeshPart> parts) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Bounds b{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const MeshPart& part : parts)
    for (const Vertex& vertex : part.mesh.vertices) {
      const Vec3 p = to_vec3(vertex.position);
      b.low = {std::min(b.low.x, p.x), std::min(b.low.y, p.y), std::min(b.low.z, p.z)};
      b.high = {std::max(b.high.x, p.x), std::max(b.high.y, p.y), std::max(b.high.z, p.z)};
    }
  if (!(b.low.x <= b.high.x)) throw Error("scene: expected at least one vertex, found none");
  return b;
}

Vec3 orthogonalized(Vec3 w, Vec3 n) noexcept {
  const Vec3 rest = w - dot(w, n) * n;
  if (length(rest) > 1e-9 * length(w)) return normalize(rest);
  const Vec3 axis = std::abs(n.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return normalize(axis - dot(axis, n) * n);
}

Vec3 tangent_around_y(Vec3 n) noexcept {
  return orthogonalized(cross({0, 1, 0}, n), n);
}

}  // namespace burnish
