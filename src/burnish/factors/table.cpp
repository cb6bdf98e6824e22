// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/lookup_scalar.h>
#include <burnish/factors/table.h>

namespace burnish {

namespace {

constexpr std::array<std::string_view, 4> kShapeNames{"line", "disk", "grid", "volume"};

struct Place {
  int node;
  double fraction;
};

// Returns the cell of u in [0, 1] among n nodes, and how far in it u is.
Place place(double u, int n) noexcept {
  const auto cell = definition::cell_of(u * (n - 1), n - 1.0);
  return {static_cast<int>(cell.node), cell.fraction};
}

}  // namespace

std::string_view to_string(TableShape shape) noexcept {
  return kShapeNames[static_cast<std::size_t>(shape)];
}

TableShape parse_table_shape(std::string_view name) {
  const auto known = std::ranges::find(kShapeNames, name);
  if (known == kShapeNames.end())
    throw Error(fmt::format("shape: expected line, disk, grid or volume, found '{}'", name));
  return static_cast<TableShape>(known - kShapeNames.begin());
}

Lookup locate(const TableLayout& layout, const FactorUse& use, Vec3 wi, Vec3 wo) noexcept {
  if (layout.shape == TableShape::disk) {
    // A disk maps the projected direction to the unit disk in the middle of the square of nodes.
    const DiskPoint p = to_disk(project(use.projection, wi, wo), layout.warp);
    const Place x = place(0.5 + 0.5 * p.x, layout.width), y = place(0.5 + 0.5 * p.y, layout.height);
    return {y.node * layout.width + x.node, x.fraction, y.fraction};
  }
  // Every other axis maps tan(theta / 2) of its projection through its warp.
  const Place x = place(layout.warp.forward(project_tan_half(use.projection, wi, wo)), layout.width);
  if (layout.shape == TableShape::line) return {x.node, x.fraction, 0};
  const Place y = place(layout.warp_y.forward(project_tan_half(use.projection_y, wi, wo)), layout.height);
  if (layout.shape == TableShape::grid) return {y.node * layout.width + x.node, x.fraction, y.fraction};
  const Place z = place(layout.warp_z.forward(project_tan_half(use.projection_z, wi, wo)), layout.depth);
  const int row = z.node * layout.height + y.node;
  return {row * layout.width + x.node, x.fraction, y.fraction, z.fraction};
}

Vec3 node_direction(const TableLayout& layout, int x, int y) noexcept {
  // A node's place on the line or disk is mapped back to a direction: the inverse of locate().
  const double u = static_cast<double>(x) / (layout.width - 1);
  if (layout.shape == TableShape::line) return from_disk({u, 0}, layout.warp);
  const double v = static_cast<double>(y) / (layout.height - 1);
  return from_disk({2 * u - 1, 2 * v - 1}, layout.warp);
}

void check_layout(const TableLayout& layout, const std::string& name) {
  const auto in_range = [](int n, int most) { return n >= 2 && n <= most; };
  bool fits = in_range(layout.width, kMaxSide) && layout.depth == 1;
  int most = kMaxSide;
  switch (layout.shape) {
    case TableShape::line:
      fits = fits && layout.height == 1;
      break;
    case TableShape::disk:
      fits = fits && layout.height == layout.width;
      break;
    case TableShape::grid:
      fits = fits && in_range(layout.height, kMaxSide);
      break;
    case TableShape::volume:
      most = kMaxVolumeSide;
      fits = in_range(layout.width, most) && in_range(layout.height, most) && in_range(layout.depth, most) &&
             layout.rows() <= kMaxSide;
  }
  constexpr std::array<const char*, 4> kForms{"a line (N x 1)", "a disk (N x N)", "a grid",
                                              "a volume of at most 8192 rows"};
  if (!fits)
    throw Error(fmt::format("table '{}': expected {} of sides 2 to {}, found {} x {} x {}", name,
                            kForms[static_cast<std::size_t>(layout.shape)], most, layout.width, layout.height,
                            layout.depth));
}

void check_format(const Table& table) {
  if (!holds_channels(table.format, table.channels))
    throw Error(fmt::format("table '{}': expected 3 channels for {}, found {}", table.name,
                            to_string(table.format), table.channels));
}

}  // namespace burnish
