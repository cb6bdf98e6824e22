// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/math/k_means.h>

namespace burnish {

namespace {

constexpr int kGroupingSteps = 10;

}  // namespace

double squared_distance(std::span<const double> a, std::span<const double> b) noexcept {
  double sum = 0;
  for (std::size_t d = 0; d < a.size(); ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

Groups grouped(const Points& points, std::size_t count) {
  Groups groups{.centres = {count, points.coordinates, std::vector<double>(count * points.coordinates)},
                .of = std::vector<std::size_t>(points.size),
                .sizes = {}};
  std::vector<double> nearest(points.size, INFINITY);
  for (std::size_t g = 0, next = 0; g < count; ++g) {
    std::ranges::copy(points[next], groups.centres[g].begin());
    for (std::size_t i = 0; i < points.size; ++i)
      nearest[i] = std::min(nearest[i], squared_distance(points[i], groups.centres[g]));
    next = static_cast<std::size_t>(std::ranges::max_element(nearest) - nearest.begin());
  }
  for (int step = 0; step < kGroupingSteps; ++step) {
    for (std::size_t i = 0; i < points.size; ++i) {
      double best = INFINITY;
      for (std::size_t g = 0; g < count; ++g)
        if (const double d = squared_distance(points[i], groups.centres[g]); d < best) {
          best = d;
          groups.of[i] = g;
        }
    }
    Points sums{count, points.coordinates, std::vector<double>(groups.centres.values.size())};
    groups.sizes.assign(count, 0);
    for (std::size_t i = 0; i < points.size; ++i) {
      ++groups.sizes[groups.of[i]];
      for (std::size_t d = 0; d < points.coordinates; ++d) sums[groups.of[i]][d] += points[i][d];
    }
    for (std::size_t g = 0; g < count; ++g)
      for (std::size_t d = 0; groups.sizes[g] > 0 && d < points.coordinates; ++d)
        groups.centres[g][d] = sums[g][d] / static_cast<double>(groups.sizes[g]);
  }
  return groups;
}

}  // namespace burnish
