// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>

namespace burnish {

HalfDiff to_half_diff(Vec3 wi, Vec3 wo) noexcept {
  const Vec3 h = half_vector(wi, wo);
  const double sin_theta_h = std::hypot(h.x, h.y);
  const bool upright = is_pole(h);
  const double cos_phi = upright ? 1 : h.x / sin_theta_h;
  const double sin_phi = upright ? 0 : h.y / sin_theta_h;
  // wi along the two axes that the rotation of h onto the normal takes to x and y.
  const double along_x = h.z * (cos_phi * wi.x + sin_phi * wi.y) - sin_theta_h * wi.z;
  const double along_y = cos_phi * wi.y - sin_phi * wi.x;
  // The chord is exact where wi and wo nearly meet, where d loses all its digits.
  const double theta_d = 0.5 * angle_between(wi, wo);
  return {theta_of(h), phi_of(h), theta_d, phi_of({along_x, along_y, 0})};
}

HalfDiffDirections from_half_diff(const HalfDiff& angles) noexcept {
  const Vec3 h = spherical_direction(angles.theta_h, angles.phi_h);
  const Vec3 x_axis = spherical_direction(angles.theta_h + kHalfPi, angles.phi_h);
  const Vec3 y_axis{-std::sin(angles.phi_h), std::cos(angles.phi_h), 0};
  const Vec3 d = spherical_direction(angles.theta_d, angles.phi_d);
  const Vec3 across = d.x * x_axis + d.y * y_axis;
  return {d.z * h + across, d.z * h - across};
}

}  // namespace burnish
