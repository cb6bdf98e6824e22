// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <burnish/math/vec3.h>

namespace burnish {

/// A cosine lobe seen through a linear map of directions: the distribution of normalize(M w) where w is distributed as
/// max(w.z, 0) / pi. Its integral over any polygon is the cosine's over another polygon, which has a closed form
/// [Heitz2016].
struct TransformedCosine {
  /// Rows of M^-1, which takes directions of the local frame to those of the cosine. Not singular; its size does not
  /// matter.
  std::array<double, 9> inverse{1, 0, 0, 0, 1, 0, 0, 0, 1};

  Vec3 to_cosine(Vec3 w) const noexcept {
    const auto& b = inverse;
    return {b[0] * w.x + b[1] * w.y + b[2] * w.z, b[3] * w.x + b[4] * w.y + b[5] * w.z,
            b[6] * w.x + b[7] * w.y + b[8] * w.z};
  }
  double determinant() const noexcept;
  /// Returns the density per solid angle at the unit vector w, 1/sr; its integral over the sphere is 1.
  double density(Vec3 w) const noexcept;
  /// Returns the integral of the density over the upper hemisphere, in (0, 1].
  double share_above() const noexcept;
};

/// Returns the part of a polygon with z > 0, with corners in order; empty if no part is left. The polygon is planar,
/// and the origin does not lie in its plane.
std::vector<Vec3> clipped_above(std::span<const Vec3> polygon);

/// The integral of max(w.z, 0) / pi over the directions from the origin to a convex polygon, in [0, 1], whichever
/// side is seen. Edges are exact.
double cosine_share(std::span<const Vec3> polygon) noexcept;

/// Returns the integral of the lobe's density over the directions above the horizon to a polygon, in [0, 1].
double lobe_share(const TransformedCosine& lobe, std::span<const Vec3> polygon);

}  // namespace burnish
