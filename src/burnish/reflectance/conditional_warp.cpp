// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <burnish/error.h>
#include <burnish/reflectance/conditional_warp.h>

namespace burnish {
namespace {

/// Cell of a coordinate in [0, 1] on a grid of n nodes and the place within it.
struct CellOfSide {
  int index;
  double t;

  CellOfSide(double x, int n) noexcept {
    const double at = std::clamp(x, 0.0, 1.0) * (n - 1);
    index = std::min(static_cast<int>(at), n - 2);
    t = at - index;
  }
};

/// Returns the integral from 0 to t of the line from a to b.
double integral(double a, double b, double t) noexcept {
  return t * (a + 0.5 * t * (b - a));
}

/// Returns t in [0, 1] with integral(a, b, t) = area: the root of a quadratic, in a form that does not cancel.
double solve(double a, double b, double area) noexcept {
  const double root = std::sqrt(std::max(0.0, a * a + 2 * area * (b - a)));
  return a + root > 0 ? std::clamp(2 * area / (a + root), 0.0, 1.0) : 0;
}

/// Returns the largest i in [0, n - 2] with before(i) <= value, by bisection.
template <class Before>
int find_cell(int n, double value, Before before) noexcept {
  int low = 0, high = n - 1;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    const bool below = before(middle) <= value;
    low = below ? middle : low;
    high = below ? high : middle;
  }
  return low;
}

}  // namespace

/// One cell of the mixed density: its corners (density and integral from the row's start), its two rows.
struct ConditionalWarp2::Patch {
  double d00 = 0, d10 = 0, d01 = 0, d11 = 0;  // dXY
  double before0 = 0, before1 = 0;
  double total0 = 0, total1 = 0, rows_before = 0;
};

ConditionalWarp2::ConditionalWarp2(int width, int height, std::span<const float> density)
    : width_(width), height_(height) {
  if (width < 2 || height < 2) throw Error("a warp's density: expected at least 2 by 2 nodes");
  const std::size_t w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  if (density.empty() || density.size() % (w * h) != 0)
    throw Error("a warp's density: expected whole slices");
  nodes_.resize(density.size());
  rows_.resize(density.size() / w);
  std::vector<double> before(w * h), total(h);  // of one slice
  for (std::size_t slice = 0; slice < rows_.size() / h; ++slice) {
    const auto values = density.subspan(slice * w * h, w * h);
    // Trapezoids integrate along each row, then over the rows' totals.
    double sum = 0;
    for (std::size_t y = 0; y < h; ++y) {
      double row = 0;
      for (std::size_t x = 0; x < w; ++x) {
        const double value = values[y * w + x];
        if (!(value >= 0 && std::isfinite(value)))
          throw Error("a warp's density: expected finite values >= 0, found " + std::to_string(value));
        if (x > 0) row += 0.5 * (value + values[y * w + x - 1]);
        before[y * w + x] = row;
      }
      total[y] = row;
      if (y > 0) sum += 0.5 * (row + total[y - 1]);
    }
    if (!(sum > 0)) throw Error("a warp's density: expected a positive value in every slice");
    // Everything is scaled so that the slice integrates to 1.
    double rows_before = 0;
    for (std::size_t y = 0; y < h; ++y) {
      if (y > 0) rows_before += 0.5 * (total[y] + total[y - 1]);
      rows_[slice * h + y] = {total[y] / sum, rows_before / sum};
      for (std::size_t i = y * w; i < (y + 1) * w; ++i)
        nodes_[slice * w * h + i] = {values[i] / sum, before[i] / sum};
    }
  }
}

ConditionalWarp2::Patch ConditionalWarp2::patch(int column, int row, const SliceMix& mix) const noexcept {
  Patch p;
  for (int i = 0; i < mix.count; ++i) {
    // The mixed density is the weighted sum of the slices', and so are its integrals.
    const double weight = mix.weight[static_cast<std::size_t>(i)];
    const std::size_t first_row =
        std::size_t{mix.slice[static_cast<std::size_t>(i)]} * static_cast<std::size_t>(height_) +
        static_cast<std::size_t>(row);
    const Row* r = &rows_[first_row];
    const Node* n0 = &nodes_[first_row * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)];
    const Node* n1 = n0 + width_;
    p.d00 += weight * n0[0].density;
    p.d10 += weight * n0[1].density;
    p.d01 += weight * n1[0].density;
    p.d11 += weight * n1[1].density;
    p.before0 += weight * n0[0].before;
    p.before1 += weight * n1[0].before;
    p.total0 += weight * r[0].total;
    p.total1 += weight * r[1].total;
    p.rows_before += weight * r[0].before;
  }
  return p;
}

double ConditionalWarp2::pdf(Point2 point, const SliceMix& mix) const noexcept {
  const CellOfSide x(point.x, width_), y(point.y, height_);
  const Patch p = patch(x.index, y.index, mix);
  // The density is bilinear in the cell; nodes are 1 / (n - 1) apart.
  const double a = std::lerp(p.d00, p.d01, y.t), b = std::lerp(p.d10, p.d11, y.t);
  return std::lerp(a, b, x.t) * (width_ - 1) * (height_ - 1);
}

Point2 ConditionalWarp2::invert(Point2 point, const SliceMix& mix) const noexcept {
  // u.x is the share of the row before the point. Rows are interpolated linearly between the two nodes.
  const CellOfSide x(point.x, width_), y(point.y, height_);
  const Patch p = patch(x.index, y.index, mix);
  const auto along_y = [t = y.t](double a, double b) { return a + t * (b - a); };
  const double total = along_y(p.total0, p.total1);
  const double in_row =
      along_y(p.before0, p.before1) + integral(along_y(p.d00, p.d01), along_y(p.d10, p.d11), x.t);
  // u.y is the share of the rows before it.
  const double v = p.rows_before + integral(p.total0, p.total1, y.t);
  return {total > 0 ? std::min(in_row / total, 1.0) : point.x, std::min(v, 1.0)};
}

Point2 ConditionalWarp2::warp(Point2 u, const SliceMix& mix) const noexcept {
  // The row is where the rows' totals sum to u.y.
  const int row =
      find_cell(height_, u.y, [&](int y) { return patch(0, std::min(y, height_ - 2), mix).rows_before; });
  const Patch rows = patch(0, row, mix);
  const double ty = solve(rows.total0, rows.total1, u.y - rows.rows_before);

  // The place in the row is where its density sums to u.x of its total.
  const double target = u.x * std::lerp(rows.total0, rows.total1, ty);
  const int column = find_cell(width_, target, [&](int x) {
    const Patch p = patch(std::min(x, width_ - 2), row, mix);
    return std::lerp(p.before0, p.before1, ty);
  });
  const Patch p = patch(column, row, mix);
  const double tx = solve(std::lerp(p.d00, p.d01, ty), std::lerp(p.d10, p.d11, ty),
                          target - std::lerp(p.before0, p.before1, ty));
  return {(column + tx) / (width_ - 1), (row + ty) / (height_ - 1)};
}

}  // namespace burnish
