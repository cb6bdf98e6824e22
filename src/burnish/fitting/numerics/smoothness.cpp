// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <initializer_list>

#include <burnish/fitting/numerics/smoothness.h>

namespace burnish {

namespace {

// Weight of differences between nodes of a pole, beside second derivatives: no sample outweighs them.
constexpr double kPoleShare = 100;
// Weight of differences between both ends of a circle: volumes are refined at a smoothness of 1e-9.
constexpr double kCircleShare = 1e4;

struct Term {
  int node;
  double coefficient;
};

void add_row(SmoothnessRows& rows, double scale, std::initializer_list<Term> terms) {
  for (const Term& t : terms) {
    rows.nodes.push_back(static_cast<std::uint32_t>(t.node));
    rows.coefficients.push_back(scale * t.coefficient);
  }
  rows.starts.push_back(static_cast<std::uint32_t>(rows.nodes.size()));
}

}  // namespace

SmoothnessRows smoothness_rows(const TableLayout& layout, TableEdges edges) {
  SmoothnessRows rows;
  const int w = layout.width, h = layout.height, d = layout.depth, layer = w * h;
  const auto cells = [](int nodes) { return nodes > 1 ? nodes - 1.0 : 1.0; };
  const double nx = cells(w), ny = cells(h), nz = cells(d);
  // Rows are roots of the terms of an integral over cells of size 1/nx x 1/ny x 1/nz: differences over powers of the
  // spacing.
  const double volume = 1 / (nx * ny * nz), root = std::sqrt(volume), twice = std::sqrt(2 * volume);
  const double xx = nx * nx * root, yy = ny * ny * root, zz = nz * nz * root, xy = nx * ny * twice,
               xz = nx * nz * twice, yz = ny * nz * twice;
  const double slope =
                   std::sqrt((layout.shape == TableShape::volume ? kVolumeSlopeShare : kSlopeShare) * volume),
               dx = nx * slope, dy = ny * slope, dz = nz * slope;
  for (int z = 0; z < d; ++z)
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        // Each node adds its second differences, mixed ones twice as strongly, and its first differences.
        const int i = (z * h + y) * w + x;
        const auto mixed = [&](double scale, int a, int b) {
          add_row(rows, scale, {{i, 1}, {i + a, -1}, {i + b, -1}, {i + a + b, 1}});
        };
        const bool next_x = x + 1 < w, next_y = y + 1 < h, next_z = z + 1 < d;
        if (x > 0 && next_x) add_row(rows, xx, {{i - 1, 1}, {i, -2}, {i + 1, 1}});
        if (y > 0 && next_y) add_row(rows, yy, {{i - w, 1}, {i, -2}, {i + w, 1}});
        if (next_x && next_y) mixed(xy, 1, w);
        if (next_x) add_row(rows, dx, {{i, -1}, {i + 1, 1}});
        if (next_y) add_row(rows, dy, {{i, -1}, {i + w, 1}});
        if (z > 0 && next_z) add_row(rows, zz, {{i - layer, 1}, {i, -2}, {i + layer, 1}});
        if (next_x && next_z) mixed(xz, 1, layer);
        if (next_y && next_z) mixed(yz, w, layer);
        if (next_z) add_row(rows, dz, {{i, -1}, {i + layer, 1}});
      }
  // A polar angle's function is even about the normal: its slope vanishes there.
  if (layout.shape == TableShape::line && w > 1) add_row(rows, xx, {{0, -1}, {1, 1}});
  if (layout.shape == TableShape::volume && edges.circle_z)
    for (int i = 0; i < layer; ++i) add_row(rows, kCircleShare * zz, {{i, -1}, {(d - 1) * layer + i, 1}});
  if (layout.shape != TableShape::grid) return rows;
  if (edges.even_y && h > 1)
    for (int x = 0; x < w; ++x) add_row(rows, yy, {{x, -1}, {x + w, 1}});
  if (edges.pole_x && w > 1)
    for (int y = 0; y < h; ++y) {
      add_row(rows, xx, {{y * w, -1}, {y * w + 1, 1}});
      if (y + 1 < h) add_row(rows, kPoleShare * xx, {{y * w, -1}, {y * w + w, 1}});
    }
  return rows;
}

}  // namespace burnish
