// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <burnish/eval/visible_half_map.h>
#include <burnish/eval/visible_half_scalar.h>
#include <burnish/math/angles.h>

namespace burnish {
namespace {

// A half vector of a view's quadrature rule, in the terms of the map.
struct HalfPoint {
  double x, y, m, along, to_half;  // unit azimuth (isotropic: from wo), tan^2(theta_h / 2), wo.azimuth, wo.h
  double squares;                  // sum of the solid angle's size squared
};

struct PreparedView {
  double up;
  std::vector<HalfPoint> points;
  double total = 0;
};

PreparedView prepare(const ReflectedLight& view, bool isotropic) {
  PreparedView prepared{.up = view.wo.z, .points = {}};
  const auto plane = scalar::unit_axis(view.wo.x, view.wo.y);
  for (std::size_t i = 0; i < view.rule.size(); ++i) {
    // m = tan^2(theta_h / 2) = |xy|^2 / (|sum| + z)^2, and wo.h = |wi + wo| / 2.
    const auto& [wi, weight] = view.rule[i];
    const Vec3 sum = wi + view.wo;
    const double reach = length(sum), up = reach + sum.z;
    auto axis = scalar::unit_axis(sum.x, sum.y);
    const double along = view.wo.x * axis.x + view.wo.y * axis.y;
    if (isotropic)
      axis = {axis.x * plane.x + axis.y * plane.y, std::abs(axis.y * plane.x - axis.x * plane.y)};
    const double light = view.size[i] * weight;
    prepared.points.push_back({axis.x, axis.y, (sum.x * sum.x + sum.y * sum.y) / (up * up), along,
                               0.5 * reach, light * view.size[i]});
    prepared.total += light;
  }
  return prepared;
}

// Returns the logarithm of the relative second moment of the weights for cells of one map. It is the mean over the
// views, so that no single view dominates. A cell's mass is the root of the mean square of its reflected light, which
// minimizes the moment.
double log_second_moment(const std::vector<PreparedView>& views, const VisibleHalfMap& map, bool isotropic,
                         int rows, int columns, std::vector<double>& squares) {
  SamplerView view;
  static_cast<VisibleHalfMap&>(view) = map;
  double mean = 0;
  for (const PreparedView& v : views) {
    std::fill(squares.begin(), squares.end(), 0.0);
    for (const HalfPoint& p : v.points) {
      const double x = map.xx * p.x + map.xy * p.y, y = map.xy * p.x + map.yy * p.y;
      const double stretch = x * x + y * y, narrowing = 1 / stretch;
      const double w = scalar::place_on_half_circle(scalar::Arrow<double>{x, y, std::sqrt(stretch)});
      const scalar::Ray<double> ray(view, narrowing, p.along, v.up, v.up * v.up);
      const double turned = scalar::turn(w, y) * (isotropic ? 0.5 : 0.25);
      const int row = std::min(static_cast<int>(turned * rows), rows - 1);
      const int column = std::clamp(static_cast<int>(ray.to_unit(p.m) * columns), 0, columns - 1);
      const auto cell = static_cast<std::size_t>(row * columns + column);
      squares[cell] += p.squares / ray.density(p.m, p.to_half, scalar::turning(w, narrowing));
    }
    // The least second moment is the square of the sum of the masses, relative to the square of the light.
    double sum = 0;
    for (const double square : squares) sum += std::sqrt(square);
    const double range = 1.0 / (0.25 * rows * columns);  // range of a cell in turn and v, halves folded
    mean += std::log(sum * sum * range / (v.total * v.total));
  }
  return mean / static_cast<double>(views.size());
}

VisibleHalfMap stretched(double sharpness, double share, double log_aspect, double turn) {
  // M = R diag(s, 1/s) R^T stretches by s along the direction `turn`.
  const double s = std::exp(log_aspect), c = std::cos(turn), t = std::sin(turn);
  return {sharpness, share, s * c * c + t * t / s, (s - 1 / s) * c * t, s * t * t + c * c / s};
}

}  // namespace

VisibleHalfMap fit_visible_half_map(const std::vector<ReflectedLight>& views, bool isotropic, int rows,
                                    int columns) {
  std::vector<PreparedView> prepared;
  for (const ReflectedLight& view : views) {
    prepared.push_back(prepare(view, isotropic));
    if (!(prepared.back().total > 0)) prepared.pop_back();
  }
  VisibleHalfMap best;
  if (prepared.empty()) return best;
  const auto cells = static_cast<std::size_t>(rows * columns);
  std::vector<double> squares(cells);
  double least = std::numeric_limits<double>::infinity();
  std::array<double, 4> at{};  // log sharpness, share, log aspect, turn

  // Keeps parameters if they are better than the best so far.
  const auto consider = [&](std::array<double, 4> p) {
    p[0] = std::clamp(p[0], std::log(1e-7), std::log(1.0));
    p[1] = std::clamp(p[1], 0.0, 0.98);
    const VisibleHalfMap map = stretched(std::exp(p[0]), p[1], p[2], p[3]);
    const double moment = log_second_moment(prepared, map, isotropic, rows, columns, squares);
    if (!(moment < least)) return false;
    least = moment;
    best = map;
    at = p;
    return true;
  };

  // A grid of round maps is tried first, then stretched ones around the best.
  for (int k = 0; k < 12; ++k)
    for (const double share : {0.3, 0.6, 0.85, 0.95}) consider({-1.25 * k, share, 0, 0});
  if (!isotropic) {
    const std::array<double, 4> round = at;
    for (const double aspect : {0.5, 1.0, 1.7})
      for (int k = 0; k < 4; ++k)
        for (const double narrower : {0.0, 1.0})
          consider({round[0] - narrower, round[1], aspect, k * kPi / 4});
  }

  // Finally each parameter is moved in turn, as long as that helps, by ever smaller steps.
  std::array<double, 4> step{0.6, 0.1, 0.25, kPi / 12};
  for (int pass = 0; pass < 9; ++pass) {
    for (std::size_t k = 0; k < (isotropic ? 2 : 4); ++k)
      for (const double sign : {-1.0, 1.0})
        for (int moves = 0; moves < 3; ++moves) {
          std::array<double, 4> next = at;
          next[k] += sign * step[k];
          if (!consider(next)) break;
        }
    for (double& s : step) s *= 0.6;
  }
  return best;
}

}  // namespace burnish
