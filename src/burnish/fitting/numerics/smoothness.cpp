#include <cmath>
#include <initializer_list>

#include <burnish/fitting/numerics/smoothness.h>

namespace burnish {

namespace {

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

SmoothnessRows smoothness_rows(const TableLayout& layout) {
  SmoothnessRows rows;
  const int w = layout.width, h = layout.height;
  const double nx = w > 1 ? w - 1 : 1, ny = h > 1 ? h - 1 : 1;
  // An integral over cells of size 1/nx x 1/ny of squared differences over powers of the spacing.
  const double area = 1 / (nx * ny);
  const double xx = nx * nx * std::sqrt(area), yy = ny * ny * std::sqrt(area),
               xy = nx * ny * std::sqrt(2 * area);
  const double dx = nx * std::sqrt(kSlopeShare * area), dy = ny * std::sqrt(kSlopeShare * area);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const int i = y * w + x;
      if (x > 0 && x + 1 < w) add_row(rows, xx, {{i - 1, 1}, {i, -2}, {i + 1, 1}});
      if (y > 0 && y + 1 < h) add_row(rows, yy, {{i - w, 1}, {i, -2}, {i + w, 1}});
      if (x + 1 < w && y + 1 < h) add_row(rows, xy, {{i, 1}, {i + 1, -1}, {i + w, -1}, {i + w + 1, 1}});
      if (x + 1 < w) add_row(rows, dx, {{i, -1}, {i + 1, 1}});
      if (y + 1 < h) add_row(rows, dy, {{i, -1}, {i + w, 1}});
    }
  }
  // A polar angle's function is even about the normal: its slope vanishes there.
  if (layout.shape == TableShape::line && w > 1) add_row(rows, xx, {{0, -1}, {1, 1}});
  return rows;
}

}  // namespace burnish
