// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace burnish {

/// The half vectors h for which the mirror of wo about h stays above the horizon are a region that is
/// star-shaped about the normal: along every azimuth they reach from the normal to a largest polar angle,
///   2 theta_h = arccot(-along / up),
/// where up = wo.z > 0 and `along` is the component of wo along the azimuth. This is tan^2(theta_h / 2)
/// there, in [0, 1]; without cancellation.
inline double largest_visible_half(double along, double up) noexcept {
  const double length = std::hypot(along, up), sum = length + std::abs(along);
  // cos^2 and sin^2 of theta_h, the smaller of them first; cos(2 theta_h) = -along / length
  const double small = up * up / (2 * length * sum), large = sum / (2 * length);
  const double cosine = std::sqrt(along > 0 ? small : large);
  return (along > 0 ? large : small) / ((1 + cosine) * (1 + cosine));
}

}  // namespace burnish
