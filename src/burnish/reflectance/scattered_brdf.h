#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/reflectance/samples.h>

namespace burnish {

/// Scattered samples made into a function: the weighted mean of the samples near a direction pair, weight
/// exp(-100 distance^2). Isotropic samples are compared in the reciprocal space (sin theta_i sin theta_o,
/// |phi_i - phi_o| / pi, cos theta_i cos theta_o), anisotropic ones in (wi.x, wi.y, wo.x, wo.y). The search
/// radius starts at a square of 0.001 (less for sets denser than 1439 samples, see initial_radius2), and its
/// square doubles until it holds three samples; a pair that needs more than kMaxRadius2 is outside the
/// coverage: unknown. Evaluation costs O(log n) for the usual even coverage. Source: [Pharr 2010] for the
/// isotropic space, the weight and the radius.
class ScatteredBrdf {
 public:
  /// Largest square of the search radius, a sixth of the space's extent.
  static constexpr double kMaxRadius2 = 0.064;

  /// Keeps a copy of the samples. Throws Error if there are none, or a sample's values are not as many as its
  /// channels.
  explicit ScatteredBrdf(Samples samples);

  /// The same from a part of the samples, for cross-validation.
  ScatteredBrdf(const Samples& samples, std::span<const std::size_t> subset);

  int channels() const noexcept { return samples_.channels; }
  bool isotropic() const noexcept { return samples_.isotropic; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  const Samples& samples() const noexcept { return samples_; }
  /// 0.001 min(1, (1439 / n)^(2/d)) in d dimensions: as many samples in reach as the Cornell sets have, so
  /// that denser sets are blurred less.
  double initial_radius2() const noexcept { return initial_radius2_; }

 private:
  using Point = std::array<double, 4>;

  Point place(Vec3 wi, Vec3 wo) const noexcept;

  Samples samples_;  // in the order of the tree
  std::vector<Point> points_;
  // Split axis of the node whose pivot is point i; a k-d tree without pointers: a range's pivot is its
  // middle.
  std::vector<std::uint8_t> axes_;
  double initial_radius2_ = 0;
};

static_assert(Brdf<ScatteredBrdf>);

/// The chosen samples, in the order given. Precondition: indices below samples.size().
Samples select(const Samples& samples, std::span<const std::size_t> subset);

}  // namespace burnish
