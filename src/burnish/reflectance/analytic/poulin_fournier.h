// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/analytic/pair_geometry.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Parallel cylinders of radius 1 along the tangent, half sunk into a floor and hiding each other from light
/// and viewer; cylinders and floor reflect by a normalized Blinn-Phong lobe and kd / pi. Reflected light is
/// integrated over the arc both lit and visible (Gauss-Legendre; relative error of the diffuse part below
/// 1e-9, of the specular part below 1e-4). Reciprocal; conserving for kd + ks <= 1; single reflection.
/// Source: [Poulin 1990], whose Chebyshev approximation the quadrature replaces; its cylinders raised above
/// their radius and its subtracted cylinders are left out.
struct PoulinFournier {
  double spacing = 2.5;  ///< distance of neighbouring axes in radii, >= 2
  double height = 1;     ///< how far a cylinder stands out of the floor, in radii, in (0, 1]
  double exponent = 50;  ///< of the local lobe, >= 1
  Rgb kd = 0.2, ks = 0.8;

  static constexpr std::size_t channels() noexcept { return 3; }
  static constexpr bool isotropic() noexcept { return false; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  struct Interval {
    double lo, hi;  ///< empty where hi <= lo
  };
  /// Part of a cylinder's cross-section seen from direction w (w.z > 0) past its neighbours: angles from the
  /// normal towards s = +y, radians.
  Interval visible_arc(Vec3 w) const noexcept;
  /// Part of the floor between two cylinders seen from w: distances from the left axis, in radii.
  Interval visible_floor(Vec3 w) const noexcept;
};

static_assert(Brdf<PoulinFournier>);

}  // namespace burnish
