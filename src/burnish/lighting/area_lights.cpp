// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/lighting/area_lights.h>
#include <burnish/math/angles.h>

namespace burnish {

std::array<Vec3, 4> rectangle_light(Vec3 centre, Vec3 half_u, Vec3 half_v) noexcept {
  return {centre - half_u - half_v, centre + half_u - half_v, centre + half_u + half_v,
          centre - half_u + half_v};
}

std::vector<Vec3> disk_light(Vec3 centre, Vec3 half_u, Vec3 half_v, int corners) {
  if (corners < 3 || corners > 4096)
    throw Error(fmt::format("disk light: expected corners in [3, 4096], found {}", corners));
  // n sin(2 pi / n) / 2 is the area inside the unit circle
  const double step = kTwoPi / corners, size = std::sqrt(step / std::sin(step));
  std::vector<Vec3> polygon;
  for (int i = 0; i < corners; ++i)
    polygon.push_back(centre + size * std::cos(i * step) * half_u + size * std::sin(i * step) * half_v);
  return polygon;
}

std::vector<Vec3> sphere_light(Vec3 centre, double radius, int corners) {
  const double distance = length(centre);
  if (!(radius > 0) || !(distance > radius))
    throw Error(
        fmt::format("sphere light: expected a radius in (0, {}), the distance, found {}", distance, radius));
  const Vec3 to = (1 / distance) * centre;
  const Vec3 u = normalize(cross(std::abs(to.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, to)), v = cross(to, u);
  // The size is the tangent of the angle between the centre and the sphere's rim.
  const double size = radius / std::sqrt(distance * distance - radius * radius);
  return disk_light(to, size * u, size * v, corners);
}

std::array<Vec3, 4> line_light(Vec3 from, Vec3 to, double radius) noexcept {
  const Vec3 along = to - from;
  const Vec3 across = radius * normalize(cross(along, from));
  return {from - across, to - across, to + across, from + across};
}

}  // namespace burnish
