// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/math/vec3.h>

namespace burnish {

// The cosine that the specular power is taken of. All directions have length 1; the normal need not be the
// frame's.

/// Phong's cosine between the mirrored light and the viewer, 2 (n.wi)(n.wo) - wi.wo, in [-1, 1].
/// Source: [Phong 1975], [QuadraticBrdf].
constexpr double phong_cosine(Vec3 wi, Vec3 wo, Vec3 normal) noexcept {
  return 2 * dot(normal, wi) * dot(normal, wo) - dot(wi, wo);
}

/// Blinn's cosine between normal and half vector, n.(wi + wo) / |wi + wo|, in [-1, 1]; n.n = 1 where
/// wi = -wo. Source: [Blinn 1977], [QuadraticBrdf].
inline double blinn_cosine(Vec3 wi, Vec3 wo, Vec3 normal) noexcept {
  const Vec3 sum = wi + wo;
  const double l = length(sum);
  return l > 0 ? dot(normal, sum) / l : 1.0;
}

/// Squared chord |a - b|^2 = 2 - 2 cos of the angle between two directions, in [0, 4]. Lyon measures the
/// angle by it because a small chord keeps its digits where the cosine is near 1. Source: [Lyon 1993].
constexpr double chord_squared(Vec3 a, Vec3 b) noexcept {
  return dot(a - b, a - b);
}

/// Normalizes an interpolated normal without division or square root: 1/sqrt(q) by three Taylor terms about
/// q = n.n = 1, that is (15 - 10 q + 3 q^2) / 8. Domain: any vector; the length returned is within
/// 5/16 |q - 1|^3 of 1 (to first order: 2.5e-3 for q = 0.8) and never above 1 for q <= 1. Source: [Lyon
/// 1993].
constexpr Vec3 taylor_normalize(Vec3 n) noexcept {
  const double q = dot(n, n);
  return (15 - q * (10 - 3 * q)) / 8 * n;
}

}  // namespace burnish
