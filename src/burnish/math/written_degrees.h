// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <burnish/math/angles.h>

namespace burnish {

/// Degrees of an angle in radians, less `offset_deg`, with as few decimals as give the same angle back: 30 where
/// degrees() gives 29.999999999999996. Nothing is lost: radians(result + offset_deg) is `rad` to the last bit, or to
/// four roundings where no short number is.
inline double written_degrees(double rad, double offset_deg = 0) noexcept {
  const double plain = degrees(rad) - offset_deg;
  const auto same = [&](double deg, double tolerance) {
    return std::abs(radians(deg + offset_deg) - rad) <= tolerance;
  };
  for (const double tolerance : {0.0, 8e-16 * std::abs(rad)})
    for (const double decimals : {1.0, 1e3, 1e6, 1e10}) {
      const double rounded = std::round(plain * decimals) / decimals;
      if (same(rounded, tolerance)) return rounded;
    }
  return plain;
}

}  // namespace burnish
