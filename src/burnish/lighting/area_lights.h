// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <burnish/math/vec3.h>

namespace burnish {

/// These functions return lights as polygons, in the frame of their arguments. The lit point is the origin. All
/// corners are in order.

/// Returns a rectangle from its centre and half its sides.
std::array<Vec3, 4> rectangle_light(Vec3 centre, Vec3 half_u, Vec3 half_v) noexcept;

/// Returns a disk, or an ellipse, from its centre and two half axes at right angles, as a polygon of `corners`
/// corners with the same area. The reflection of a cosine lobe errs by less than 7 / corners^2 of the light; 16 or
/// more corners suit. Throws Error unless corners is in [3, 4096].
std::vector<Vec3> disk_light(Vec3 centre, Vec3 half_u, Vec3 half_v, int corners = 32);

/// Returns the disk that covers the same directions as a sphere seen from the origin, so that the only error is the
/// polygon's. Throws Error as disk_light does, and if the origin is not outside the sphere.
std::vector<Vec3> sphere_light(Vec3 centre, double radius, int corners = 32);

/// Returns a tube from end to end, as the rectangle whose broad side faces the origin; the tube's ends are left out.
/// The error is of the order of (radius / distance)^2. The origin must not be on the tube's line.
std::array<Vec3, 4> line_light(Vec3 from, Vec3 to, double radius) noexcept;

}  // namespace burnish
