// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace burnish {

/// A vector of the local frame: normal n = +z, tangent t = +x, s = n x t = +y. Directions have length 1.
struct Vec3 {
  double x = 0, y = 0, z = 0;

  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 a, Vec3 b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator-(Vec3 a) noexcept {
  return {-a.x, -a.y, -a.z};
}
constexpr Vec3 operator*(double s, Vec3 a) noexcept {
  return {s * a.x, s * a.y, s * a.z};
}
constexpr Vec3 operator*(Vec3 a, double s) noexcept {
  return s * a;
}
constexpr double dot(Vec3 a, Vec3 b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 a, Vec3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) noexcept {
  return std::sqrt(dot(a, a));
}

/// a / |a|; the normal (0, 0, 1) where |a| is zero, so that the result is always a direction.
inline Vec3 normalize(Vec3 a) noexcept {
  const double l = length(a);
  return l > 0 ? (1 / l) * a : Vec3{0, 0, 1};
}

/// Half vector of two directions, normalize(wi + wo); the normal where they are opposite.
inline Vec3 half_vector(Vec3 wi, Vec3 wo) noexcept {
  return normalize(wi + wo);
}

/// Mirror of w about the normal: (-x, -y, z).
constexpr Vec3 mirror(Vec3 w) noexcept {
  return {-w.x, -w.y, w.z};
}

}  // namespace burnish
