// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <burnish/math/vec3.h>

namespace burnish {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kHalfPi = kPi / 2;
inline constexpr double kTwoPi = 2 * kPi;

constexpr double radians(double deg) noexcept {
  return deg * (kPi / 180);
}
constexpr double degrees(double rad) noexcept {
  return rad * (180 / kPi);
}

/// Direction at polar angle theta from the normal and azimuth phi from the tangent (radians).
inline Vec3 spherical_direction(double theta, double phi) noexcept {
  const double s = std::sin(theta);
  return {s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
}

/// Polar angle of direction w in [0, pi], accurate near the poles too.
inline double theta_of(Vec3 w) noexcept {
  return std::atan2(std::hypot(w.x, w.y), w.z);
}

/// Returns true if w is a pole to within 1e-13, which rounding makes of one: its azimuth means nothing.
inline bool is_pole(Vec3 w) noexcept {
  constexpr double kRounding = 1e-13;
  return std::abs(w.x) < kRounding && std::abs(w.y) < kRounding;
}

/// Azimuth of direction w in [0, 2 pi); 0 at the poles.
inline double phi_of(Vec3 w) noexcept {
  if (is_pole(w)) return 0;
  const double phi = std::atan2(w.y, w.x);
  return phi < 0 ? std::min(phi + kTwoPi, std::nextafter(kTwoPi, 0.0)) : phi;
}

/// Angle between two directions in [0, pi], accurate at both ends.
inline double angle_between(Vec3 a, Vec3 b) noexcept {
  return 2 * std::atan2(length(a - b), length(a + b));
}

}  // namespace burnish
