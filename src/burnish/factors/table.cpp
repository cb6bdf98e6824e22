#include <algorithm>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/lookup_scalar.h>
#include <burnish/factors/table.h>

namespace burnish {

namespace {

struct Place {
  int node;
  double fraction;
};

// Where u in [0, 1] falls among n nodes.
Place place(double u, int n) noexcept {
  const auto cell = definition::cell_of(u * (n - 1), n - 1.0);
  return {static_cast<int>(cell.node), cell.fraction};
}

}  // namespace

Lookup locate(const TableLayout& layout, const FactorUse& use, Vec3 wi, Vec3 wo) noexcept {
  if (layout.shape == TableShape::disk) {
    const DiskPoint p = to_disk(project(use.projection, wi, wo), layout.warp);
    const Place x = place(0.5 + 0.5 * p.x, layout.width), y = place(0.5 + 0.5 * p.y, layout.height);
    return {y.node * layout.width + x.node, x.fraction, y.fraction};
  }
  const Place x = place(layout.warp.forward(project_tan_half(use.projection, wi, wo)), layout.width);
  if (layout.shape == TableShape::line) return {x.node, x.fraction, 0};
  const Place y = place(layout.warp_y.forward(project_tan_half(use.projection_y, wi, wo)), layout.height);
  return {y.node * layout.width + x.node, x.fraction, y.fraction};
}

Vec3 node_direction(const TableLayout& layout, int x, int y) noexcept {
  const double u = static_cast<double>(x) / (layout.width - 1);
  if (layout.shape == TableShape::line) return from_disk({u, 0}, layout.warp);
  const double v = static_cast<double>(y) / (layout.height - 1);
  return from_disk({2 * u - 1, 2 * v - 1}, layout.warp);
}

void check_layout(const TableLayout& layout, const std::string& name) {
  const auto in_range = [](int n) { return n >= 2 && n <= kMaxSide; };
  const bool height_fits = layout.shape == TableShape::line   ? layout.height == 1
                           : layout.shape == TableShape::disk ? layout.height == layout.width
                                                              : in_range(layout.height);
  if (!in_range(layout.width) || !height_fits)
    throw Error(fmt::format("table '{}': expected {} of sides 2 to {}, found {} x {}", name,
                            layout.shape == TableShape::line   ? "a line (N x 1)"
                            : layout.shape == TableShape::disk ? "a disk (N x N)"
                                                               : "a grid",
                            kMaxSide, layout.width, layout.height));
}

void check_format(const Table& table) {
  if (!holds_channels(table.format, table.channels))
    throw Error(fmt::format("table '{}': expected 3 channels for {}, found {}", table.name,
                            to_string(table.format), table.channels));
}

}  // namespace burnish
