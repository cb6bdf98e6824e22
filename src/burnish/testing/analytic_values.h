// SPDX-License-Identifier: Apache-2.0
#pragma once

// Directions at which the tests of analytic models evaluate them. The tests compare with closed forms at special
// directions and with the numbers that tests/reference/analytic_models.py prints. That script computes apart from the
// library, from angles and the textbook forms. It finds albedos by the midpoint rule over half vectors, and cylinders
// by rays against the circles around.

#include <array>

#include <burnish/math/angles.h>
#include <burnish/reflectance/brdf.h>

namespace burnish::fixtures {

inline constexpr Vec3 kNormal{0, 0, 1};

inline Vec3 at(double theta_deg, double phi_deg) {
  return spherical_direction(radians(theta_deg), radians(phi_deg));
}

// A general pair lies off every plane of symmetry.
inline const Vec3 kA = at(50, 20), kB = at(35, 170);

/// Returns the first of three channels.
template <Brdf T>
double grey(const T& brdf, Vec3 wi, Vec3 wo) {
  std::array<double, 3> f;
  brdf.eval(wi, wo, f);
  return f[0];
}

}  // namespace burnish::fixtures
