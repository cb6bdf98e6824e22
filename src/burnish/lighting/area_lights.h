#pragma once

#include <array>
#include <vector>

#include <burnish/math/vec3.h>

namespace burnish {

/// Lights as polygons, in the frame of their arguments; the point that is lit is the origin. All corners are in order.

/// A rectangle from its centre and half its sides.
std::array<Vec3, 4> rectangle_light(Vec3 centre, Vec3 half_u, Vec3 half_v) noexcept;

/// A disk, or an ellipse, from its centre and two half axes at right angles: `corners` of the same area as the disk. Of a
/// cosine the error is below 7 / corners^2 of the light; 16 or more suit. Throws Error unless corners is in [3, 4096].
std::vector<Vec3> disk_light(Vec3 centre, Vec3 half_u, Vec3 half_v, int corners = 32);

/// The disk as which a sphere is seen from the origin: same directions, so no error but the polygon's. Throws Error as
/// disk_light does, and where the origin is not outside.
std::vector<Vec3> sphere_light(Vec3 centre, double radius, int corners = 32);

/// A tube from end to end as the rectangle that turns its broad side to the origin; ends are left out. The error is of
/// the order of (radius / distance)^2. The origin is not on the tube's line.
std::array<Vec3, 4> line_light(Vec3 from, Vec3 to, double radius) noexcept;

}  // namespace burnish
