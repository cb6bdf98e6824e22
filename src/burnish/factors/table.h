// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/factors/table_format.h>
#include <burnish/parameterization/hemisphere_map.h>
#include <burnish/parameterization/projection.h>

namespace burnish {

/// The domain of a table's nodes.
/// - line: the polar angle of one projected direction, node 0 at the normal, the last at the horizon;
/// - disk: the hemisphere of one projected direction, square, the disk's rim through the outermost nodes;
/// - grid: the polar angles of two projected directions, x of the first, y of the second;
/// - volume: the polar angles of three projected directions, x, y and z of them in turn.
enum class TableShape { line, disk, grid, volume };

/// Axes that a lookup interpolates along.
constexpr int axis_count(TableShape shape) noexcept {
  return shape == TableShape::line ? 1 : shape == TableShape::volume ? 3 : 2;
}
/// Projections that a lookup takes: a disk's one has both its axes.
constexpr int projection_count(TableShape shape) noexcept {
  return shape == TableShape::disk ? 1 : axis_count(shape);
}

/// "line", "disk", "grid" or "volume".
std::string_view to_string(TableShape shape) noexcept;
/// Reads what to_string writes; throws Error on anything else.
TableShape parse_table_shape(std::string_view name);

/// The positions of a table's nodes.
struct TableLayout {
  TableShape shape = TableShape::line;
  int width = 0;   ///< nodes along x, >= 2
  int height = 1;  ///< nodes along y; 1 for a line, equal to width for a disk
  int depth = 1;   ///< nodes along z; 1 but for a volume
  Warp warp;       ///< spacing along the polar angle (disk: along the radius)
  Warp warp_y;     ///< grid, volume: spacing along y
  Warp warp_z;     ///< volume: spacing along z

  /// Rows of `width` nodes: a volume's layers one after another.
  int rows() const noexcept { return height * depth; }
  std::size_t node_count() const noexcept {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(rows());
  }

  friend bool operator==(const TableLayout&, const TableLayout&) = default;
};

/// One positive factor lambda: node (x, y, z), channel c at [((z * height + y) * width + x) * channels + c].
/// Between nodes it is the (bi-, tri-)linear interpolation of the stored values, as a texture unit computes
/// it. Largest value of a channel: 1 (rgb9e5: of the table; the channels have one geometric mean, because
/// they share exponents).
struct Table {
  std::string name;
  TableLayout layout;
  std::size_t channels = 1;  ///< 1 (shared by the BRDF's channels) or the BRDF's channel count
  std::vector<float> values;
  TableFormat format = TableFormat::single;  ///< in which `values` are stored, and which holds them exactly

  std::size_t byte_count() const noexcept { return layout.node_count() * texel_bytes(format, channels); }

  friend bool operator==(const Table&, const Table&) = default;
};

/// One use of a table in a product: which one, and what it is looked up by.
struct FactorUse {
  std::size_t table = 0;
  Projection projection;
  Projection projection_y;  ///< grid and volume only
  Projection projection_z;  ///< volume only

  friend bool operator==(const FactorUse&, const FactorUse&) = default;
};

/// The nodes that a lookup touches: first node and fractions; the others are first + 1, + width, + width + 1
/// and of a volume the same four after width * height.
struct Lookup {
  int node;           ///< (z * height + y) * width + x of the lower corner
  double fx, fy, fz;  ///< in [0, 1]; fy = 0 for a line, fz = 0 but for a volume
};

/// Returns true if two lookups find the same nodes for all directions: then they are located once.
inline bool located_alike(const TableLayout& layout, const FactorUse& use, const TableLayout& other_layout,
                          const FactorUse& other) noexcept {
  return layout == other_layout && use.projection == other.projection &&
         use.projection_y == other.projection_y && use.projection_z == other.projection_z;
}

/// Finds the nodes for directions above the horizon.
Lookup locate(const TableLayout& layout, const FactorUse& use, Vec3 wi, Vec3 wo) noexcept;

/// The projected direction that node (x, y) of a line or disk stands for (a line's at azimuth 0).
Vec3 node_direction(const TableLayout& layout, int x, int y) noexcept;

inline constexpr int kMaxSide = 8192;
/// The longest side of a volume, as 3-D textures have it, so that its layers are no more rows than kMaxSide.
inline constexpr int kMaxVolumeSide = 256;

/// Throws Error unless the sizes are in [2, kMaxSide], a volume's in [2, kMaxVolumeSide] with at most kMaxSide
/// rows, and fit the shape.
void check_layout(const TableLayout& layout, const std::string& name);

/// Throws Error unless the table's format holds its channels.
void check_format(const Table& table);

}  // namespace burnish
