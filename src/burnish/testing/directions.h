// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/math/random.h>

namespace burnish {

/// Draws a direction evenly over the sphere.
inline Vec3 random_direction(Pcg32& random) {
  const double z = 1 - 2 * random.uniform();
  return spherical_direction(std::acos(z), kTwoPi * random.uniform());
}

/// Draws a direction evenly over the upper hemisphere, z in (0, 1].
inline Vec3 random_upper_direction(Pcg32& random) {
  const double z = 1 - random.uniform();
  return spherical_direction(std::acos(z), kTwoPi * random.uniform());
}

}  // namespace burnish
