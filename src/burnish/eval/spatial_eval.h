// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>

#include <burnish/eval/lobe_evaluator.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// Evaluates a surface in float: weights and frame once a place, lobes once a pair of directions. Never allocates
/// after construction. Copies share everything, and threads may share a copy. For values above 2^-126 and equal
/// directions, the error relative to SpatialBrdf::eval is at most LobeEvaluator::rounding_bound() + 8 * 2^-24.
/// Directions in a turned frame are unit vectors to 2^-22.
class SpatialEvaluator {
 public:
  explicit SpatialEvaluator(SpatialBrdf surface);

  std::size_t channels() const noexcept { return lobes_.channels(); }
  const SpatialBrdf& surface() const noexcept { return *surface_; }
  /// Returns LobeEvaluator::rounding_bound().
  double rounding_bound() const noexcept { return lobes_.rounding_bound(); }

  /// The values at a place of the surface that are the same for all lights.
  struct Place {
    ShadingFrame frame;
    std::array<float, LobeEvaluator::kWeightStride * kMaxSurfaceLobes> weights;
  };
  /// Returns the place at (u, v) and a level of detail, see SurfaceMap::sample.
  Place place(double u, double v, double lod = 0) const noexcept;
  /// Returns the place of texel (x, y) of level 0, unfiltered.
  Place texel(int x, int y) const noexcept;

  /// f_r in 1/sr, without the cosine, for unit vectors of the surface's frame; f has channels() entries.
  void eval(const Place& place, Vec3 wi, Vec3 wo, std::span<float> f) const noexcept;

 private:
  Place place(const SurfaceMap::Place& at) const noexcept;

  std::shared_ptr<const SpatialBrdf> surface_;
  LobeEvaluator lobes_;
  bool framed_;
};

}  // namespace burnish
