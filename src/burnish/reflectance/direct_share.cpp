// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/reflectance/direct_share.h>

namespace burnish {

namespace {

constexpr double kNarrow = 2;  // direct light is more than this many times as bright as its surroundings
constexpr double kCone = radians(5), kAround = radians(10);
constexpr int kDirectionsAround = 16;

/// Returns the direction at an angle from an axis, at an azimuth around it.
Vec3 tilted(Vec3 axis, double angle, double azimuth) noexcept {
  // Any direction across the axis will do.
  const Vec3 helper = std::abs(axis.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  const Vec3 across = normalize(cross(axis, helper)), other = cross(axis, across);
  return std::cos(angle) * axis + std::sin(angle) * (std::cos(azimuth) * across + std::sin(azimuth) * other);
}

/// Returns the direct light: the excess of `peak` over `around`, times the projected solid angle.
double direct_light(double peak, double around, double solid_angle) noexcept {
  return peak > kNarrow * std::max(around, 0.0) ? (peak - std::max(around, 0.0)) * solid_angle : 0;
}

}  // namespace

LightShares light_shares(const PatchTable& table, Vec3 wi, std::size_t channel) noexcept {
  const PatchBasis& out = table.outgoing;
  const std::size_t column = table.incident.patch_of(wi), straight = out.patch_of(mirror(wi));
  const auto value = [&](std::size_t patch) {
    const std::size_t entry = (patch * table.incident.size() + column) * table.channel_count + channel;
    return static_cast<double>(table.values[entry]);
  };
  // Directions as far from the patch's centre as a ring is high lie in the patches around it.
  const Vec3 centre = out.centre(straight);
  std::size_t r = 0;
  while (out.rings[r].first + out.rings[r].count <= straight) ++r;
  const PatchRing& ring = out.rings[r];
  const double height = (ring.theta_high - ring.theta_low) * (ring.theta_low == 0 && ring.count == 1 ? 2 : 1);
  double around = 0;
  bool alone = true;  // a patch of the whole hemisphere is not narrow
  for (int k = 0; k < kDirectionsAround; ++k)
    if (const Vec3 w = tilted(centre, height, kTwoPi * k / kDirectionsAround); w.z > 0)
      if (const std::size_t patch = out.patch_of(w); patch != straight) {
        around = std::max(around, value(patch));
        alone = false;
      }
  const double direct =
      alone ? 0 : direct_light(value(straight), around, out.projected_solid_angle(straight));
  return {direct, table.albedo(wi, channel) - direct};
}

LightShares light_shares(const TensorTree& tree, Vec3 wi) noexcept {
  constexpr int kCells = 128, kRings = 8;
  const auto value = [&](Vec3 wo) {
    double f = 0;
    tree.eval_raw(wi, wo, {&f, 1});
    return f;
  };
  // Cells of the square have equal projected solid angles, so the albedo is pi times the mean.
  double sum = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const DiskPoint at = shirley_chiu_disk({(i + 0.5) / kCells, (j + 0.5) / kCells});
      sum += value({at.x, at.y, std::sqrt(std::max(0.0, 1 - at.x * at.x - at.y * at.y))});
    }
  const double albedo = kPi * sum / (kCells * kCells);

  // The cone's mean, weighted by the cosine.
  const Vec3 straight = mirror(wi);
  double light = 0, weights = 0, around = 0;
  for (int ring = 0; ring < kRings; ++ring)
    for (int k = 0; k < kDirectionsAround; ++k) {
      const Vec3 w =
          tilted(straight, kCone * std::sqrt((ring + 0.5) / kRings), kTwoPi * k / kDirectionsAround);
      if (w.z <= 0) continue;
      light += w.z * value(w);
      weights += w.z;
    }
  for (int k = 0; k < kDirectionsAround; ++k)
    if (const Vec3 w = tilted(straight, kAround, kTwoPi * k / kDirectionsAround); w.z > 0)
      around = std::max(around, value(w));
  const double cone = kTwoPi * (1 - std::cos(kCone)) * weights / (kRings * kDirectionsAround);
  const double direct = weights > 0 ? direct_light(light / weights, around, cone) : 0;
  return {direct, albedo - direct};
}

}  // namespace burnish
