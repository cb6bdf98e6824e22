#pragma once

#include <array>
#include <memory>
#include <span>

#include <burnish/eval/lobe_evaluator.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// Evaluates a surface in float: weights and frame once a place, lobes once a pair of directions. Never allocates
/// after construction; copies share everything, threads may share a copy. Against SpatialBrdf::eval the relative
/// error of values above 2^-126 is at most LobeEvaluator::rounding_bound() + 8 * 2^-24 of directions that are the
/// same; those of a turned frame are unit to 2^-22.
class SpatialEvaluator {
 public:
  explicit SpatialEvaluator(SpatialBrdf surface);

  std::size_t channels() const noexcept { return lobes_.channels(); }
  const SpatialBrdf& surface() const noexcept { return *surface_; }
  /// LobeEvaluator::rounding_bound().
  double rounding_bound() const noexcept { return lobes_.rounding_bound(); }

  /// A place of the surface: what is the same for all lights.
  struct Place {
    ShadingFrame frame;
    std::array<float, LobeEvaluator::kWeightStride * kMaxSurfaceLobes> weights;
  };
  /// At (u, v) and a level of detail, see SurfaceMap::sample.
  Place place(double u, double v, double lod = 0) const noexcept;
  /// Evaluates texel (x, y) of level 0, unfiltered.
  Place texel(int x, int y) const noexcept;

  /// f_r in 1/sr, without the cosine, of unit vectors of the surface's frame; f has channels() entries.
  void eval(const Place& place, Vec3 wi, Vec3 wo, std::span<float> f) const noexcept;

 private:
  Place place(const SurfaceMap::Place& at) const noexcept;

  std::shared_ptr<const SpatialBrdf> surface_;
  LobeEvaluator lobes_;
  bool framed_;
};

}  // namespace burnish
