// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <utility>

#include <burnish/math/kd_tree.h>

namespace burnish {

namespace {

/// Orders the indices [begin, end) as a balanced k-d tree and notes the axis of each pivot.
void sort_into_tree(std::span<const TreePoint> points, std::span<std::size_t> order,
                    std::span<std::uint8_t> axes, std::size_t begin, std::size_t end) {
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  if (end - begin <= KdTree::kLeaf) {
    std::sort(at(begin), at(end));
    return;
  }
  // the longest axis of the range's box
  TreePoint low = points[order[begin]], high = low;
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      low[k] = std::min(low[k], points[order[i]][k]);
      high[k] = std::max(high[k], points[order[i]][k]);
    }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 4; ++k)
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;

  // the pivot in the middle, what is below it in front
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(at(begin), at(middle), at(end), [&](std::size_t a, std::size_t b) {
    return std::pair(points[a][axis], a) < std::pair(points[b][axis], b);
  });
  axes[middle] = static_cast<std::uint8_t>(axis);
  sort_into_tree(points, order, axes, begin, middle);
  sort_into_tree(points, order, axes, middle + 1, end);
}

}  // namespace

KdTree::KdTree(std::span<const TreePoint> points) : order_(points.size()), axes_(points.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  sort_into_tree(points, order_, axes_, 0, points.size());
  points_.reserve(points.size());
  for (const std::size_t i : order_) points_.push_back(points[i]);
}

}  // namespace burnish
