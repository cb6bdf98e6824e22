#pragma once

#include <array>
#include <string>

#include <burnish/factors/table.h>
#include <burnish/shaders/body.h>

namespace burnish {

/// An axis of a table: its warped tan(theta / 2) in [0, 1] is multiplied with `size` and `first` added, which
/// gives cells, or texture coordinates.
struct Axis {
  double size, first;
};

/// Adds to the body what finds the position along the axis of a line or grid; returns its variable.
std::string line_position(Body& body, const Projection& projection, const Warp& warp, const Axis& axis);

/// The two positions in a disk. `axis_x.size` cells are as many rows as there are columns.
std::array<std::string, 2> disk_position(Body& body, const Projection& projection, const Warp& warp,
                                         const Axis& axis_x, const Axis& axis_y);

}  // namespace burnish
