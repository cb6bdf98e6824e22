// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/analytic/pair_geometry.h>

namespace burnish {

/// Fresnel reflectance approximated from that at normal incidence. Domain: f0 and cos_d in [0, 1].
/// Source: [Schlick 1994b, eq. 15].
constexpr Rgb fresnel_schlick(Rgb f0, double cos_d) noexcept {
  const double m = 1 - cos_d, m2 = m * m, m5 = m2 * m2 * m;
  return f0 + m5 * (1 + -1.0 * f0);
}

/// Fresnel reflectance of unpolarized light at a dielectric whose index follows from the reflectance f0 at
/// normal incidence; 1 for f0 = 1. Domain: f0 in [0, 1], cos_d in (0, 1]. Source: [Cook 1982].
inline double fresnel_dielectric(double f0, double cos_d) noexcept {
  const double root = std::sqrt(f0), index = (1 + root) / (1 - root);
  if (!(index < 1e8)) return 1;
  const double c = cos_d, g = std::sqrt(index * index + c * c - 1);
  const double a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
  return 0.5 * a * a * (1 + b * b);
}
inline Rgb fresnel_dielectric(Rgb f0, double cos_d) noexcept {
  return {fresnel_dielectric(f0.r, cos_d), fresnel_dielectric(f0.g, cos_d), fresnel_dielectric(f0.b, cos_d)};
}

}  // namespace burnish
