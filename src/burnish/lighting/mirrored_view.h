// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include <burnish/lighting/area_light_table.h>
#include <burnish/math/angles.h>

namespace burnish {

/// The frame that the matrices of an AreaLightTable refer to: y at right angles to view and normal, z along the
/// mirrored view.
struct MirroredView {
  Vec3 x, y, z;

  /// Turns a table's matrix into one of the local frame.
  TransformedCosine of_local(const std::array<double, 9>& b) const noexcept {
    TransformedCosine local;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 row = b[3 * i] * x + b[3 * i + 1] * y + b[3 * i + 2] * z;
      local.inverse[3 * i] = row.x;
      local.inverse[3 * i + 1] = row.y;
      local.inverse[3 * i + 2] = row.z;
    }
    return local;
  }
};

/// Returns the frame for a unit vector wo above the horizon. If a table has a quarter of the views, y is reversed for
/// views that are one mirror image away from it. At the normal x is the tangent.
inline MirroredView mirrored_view(Vec3 wo, AreaLightViews views) noexcept {
  const double sine = std::hypot(wo.x, wo.y);
  const Vec3 away = sine > 1e-12 ? Vec3{wo.x / sine, wo.y / sine, 0} : Vec3{1, 0, 0};
  const double side = views == AreaLightViews::quarter && wo.x * wo.y < 0 ? -1 : 1;
  return {{wo.z * away.x, wo.z * away.y, sine}, {-side * away.y, side * away.x, 0}, mirror(wo)};
}

/// Returns the position in [0, 1] along a table's polar angles.
inline double theta_position(Vec3 wo) noexcept {
  return std::hypot(wo.x, wo.y) / (1 + wo.z);
}

/// Returns the position in [0, 1] along a table's azimuths.
inline double azimuth_position(AreaLightViews views, Vec3 wo) noexcept {
  const double size = std::abs(wo.x) + std::abs(wo.y);
  if (views == AreaLightViews::line || size < 1e-12) return 0;
  const double quarter = std::abs(wo.y) / size;
  if (views == AreaLightViews::quarter) return quarter;
  if (wo.y >= 0) return 0.25 * (wo.x >= 0 ? quarter : 2 - quarter);
  return 0.25 * (wo.x < 0 ? 2 + quarter : 4 - quarter);
}

/// The last node's polar angle. It is 89 degrees, since nothing is seen from the horizon.
inline constexpr double kLastTheta = radians(89);

}  // namespace burnish
