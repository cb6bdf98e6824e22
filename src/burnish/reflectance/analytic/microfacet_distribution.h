// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>

#include <burnish/math/vec3.h>

namespace burnish {

/// exp(-(x/alpha_x)² - (y/alpha_y)²) of the slopes x = h.x / h.z, y = h.y / h.z; 0 below exp(-700) and for
/// h.z = 0.
double gaussian_of_slopes(Vec3 h, double alpha_x, double alpha_y) noexcept;

/// A distribution of microfacet normals: density(h), microfacet area per solid angle of normals and per area
/// of the surface, 1/sr, for h.z >= 0; over the hemisphere density times h.z integrates to 1.
// clang-format off
template <class T>
concept MicrofacetDistribution = requires(const T& distribution, Vec3 h) {
  { distribution.density(h) } noexcept -> std::same_as<double>;
  { distribution.isotropic() } noexcept -> std::same_as<bool>;
};
// clang-format on

/// Gaussian slopes; alpha is sqrt(2) times their deviation. alpha in [0.001, 1].
/// Source: [Walter 2007, eq. 25], anisotropic form [Heitz 2014].
struct BeckmannDistribution {
  double alpha_x = 0.2, alpha_y = 0.2;

  double density(Vec3 h) const noexcept;
  bool isotropic() const noexcept { return alpha_x == alpha_y; }
  /// Area of the unmasked microfacets that face w, projected towards w and per area of the surface:
  /// the integral of density(h) max(0, w·h); w.z (1 + Lambda(w)) in Smith's terms. Exact. Domain: w.z > 0.
  /// Source: [Heitz 2014].
  double projected_area(Vec3 w) const noexcept;
};

/// Slopes of an ellipsoid ("GGX", Trowbridge-Reitz). alpha in [0.001, 1].
/// Source: [Walter 2007, eq. 33], anisotropic form [Heitz 2014].
struct GgxDistribution {
  double alpha_x = 0.2, alpha_y = 0.2;

  double density(Vec3 h) const noexcept;
  bool isotropic() const noexcept { return alpha_x == alpha_y; }
  /// Returns the area as BeckmannDistribution::projected_area does.
  double projected_area(Vec3 w) const noexcept;
};

/// Satin: floating warp threads with Gaussian slopes (alpha_x along the tangent, alpha_y across) and, with
/// the share `cross` of the area, weft threads that cross them, the same Gaussian turned by 90 degrees.
struct CrossedGaussians {
  double alpha_x = 0.1, alpha_y = 0.4, cross = 0.2;

  double density(Vec3 h) const noexcept;
  bool isotropic() const noexcept { return alpha_x == alpha_y; }
};

static_assert(MicrofacetDistribution<BeckmannDistribution> && MicrofacetDistribution<GgxDistribution> &&
              MicrofacetDistribution<CrossedGaussians>);

}  // namespace burnish
