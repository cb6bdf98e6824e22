// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/math/vec3.h>

namespace burnish {

/// Two parabolic maps side by side hold a function of all directions: half 0 is the hemisphere y >= 0, half 1
/// is half 0 seen in a mirror that exchanges up and down. The outermost texels lie on the square around the
/// horizon and continue the map beyond it, so that no border shows.

/// Turns a vector of the world into the frame of a half, or back.
inline Vec3 in_half(int half, Vec3 w) noexcept {
  return half == 0 ? w : Vec3{w.x, -w.y, w.z};
}

/// The direction of texel (x, y) of a map with `side` texels a side; outside the unit circle it lies below
/// the map's horizon.
inline Vec3 map_direction(int x, int y, int side) noexcept {
  const double u = 2.0 * x / (side - 1) - 1, v = 2.0 * y / (side - 1) - 1, r = u * u + v * v;
  return {2 * u / (1 + r), (1 - r) / (1 + r), 2 * v / (1 + r)};
}

}  // namespace burnish
