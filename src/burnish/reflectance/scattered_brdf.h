#pragma once

#include <span>

#include <burnish/math/kd_tree.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// Where samples are neighbours.
/// - half_difference: isotropic
///   (sqrt(theta_h / (pi/2)), theta_d / (pi/2), sin theta_h sin theta_d |cos phi_d|);
///   anisotropic the half vector at radius sqrt(theta_h / (pi/2)) and azimuth phi_h, and the difference
///   vector at radius theta_d / pi and azimuth phi_h + phi_d. Highlights keep their shape.
/// - angles: (sin theta_i sin theta_o, |phi_i - phi_o| / pi, cos theta_i cos theta_o), the space of pbrt-v2,
///   for isotropic samples only; for comparison. Near the normal it mixes directions up to 10 degrees apart.
/// Both isotropic spaces are reciprocal and symmetric about the plane of incidence.
enum class SampleSpace { half_difference, angles };

/// Scattered samples made into a function: the mean of the samples near a direction pair with weights
/// exp(-100 distance^2). The search radius starts at a square of 0.001 (less for sets denser than 1439
/// samples, see initial_radius2), and its square doubles until it holds three samples; a pair that needs more
/// than kMaxRadius2 is outside the coverage: unknown. Where a scan is much denser than elsewhere the square halves
/// until at most 64 samples are in reach, or none would be. Evaluation costs O(log n) for the usual even coverage.
/// Weight, radius and the space of angles: [Pharr 2010]. Held out and interpolated from the others, a tenth
/// of the samples of three Cornell paints is met within 16, 16 and 11 % (the figure `relative`) in the
/// default space, within 17, 20 and 17 % in that of angles.
class ScatteredBrdf {
 public:
  /// Largest square of the search radius: a quarter of the extent of each coordinate.
  static constexpr double kMaxRadius2 = 0.064;

  /// Keeps a copy of the samples. Throws Error if there are none, or a sample's values are not as many as its
  /// channels.
  explicit ScatteredBrdf(Samples samples, SampleSpace space = SampleSpace::half_difference);

  /// The same from a part of the samples, for cross-validation.
  ScatteredBrdf(const Samples& samples, std::span<const std::size_t> subset,
                SampleSpace space = SampleSpace::half_difference);

  std::size_t channels() const noexcept { return samples_.channels; }
  bool isotropic() const noexcept { return samples_.isotropic; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  const Samples& samples() const noexcept { return samples_; }
  /// 0.001 min(1, (1439 / n)^(2/d)) in d dimensions: as many samples in reach as the Cornell sets have, so
  /// that denser sets are blurred less.
  double initial_radius2() const noexcept { return initial_radius2_; }

 private:
  TreePoint place(Vec3 wi, Vec3 wo) const noexcept;

  SampleSpace space_;
  Samples samples_;  // in the order of the tree
  KdTree tree_;
  double initial_radius2_ = 0;
};

static_assert(HasRawValues<ScatteredBrdf>);

/// The chosen samples, in the order given. Precondition: indices below samples.size().
Samples select(const Samples& samples, std::span<const std::size_t> subset);

}  // namespace burnish
