// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <burnish/render/scene.h>

namespace burnish {

/// The first surface that a ray meets.
struct SurfaceHit {
  std::size_t part = 0, triangle = 0;
  double u = 0, v = 0;  ///< weights of the triangle's second and third corner
};

/// Nearest hits in a scene's triangles (Embree). Refers to the parts, which must outlive it.
class RayCaster {
 public:
  explicit RayCaster(std::span<const MeshPart> parts);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// Along the unit vector `direction`. Safe to call from several threads.
  std::optional<SurfaceHit> nearest(Vec3 origin, Vec3 direction) const noexcept;
  /// Returns true if something lies between two points, except for the last and first 1e-4 of the way.
  bool blocked(Vec3 from, Vec3 to) const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace burnish
