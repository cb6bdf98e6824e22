// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace burnish {

/// A place among up to four coordinates; unused ones are 0.
using TreePoint = std::array<double, 4>;

/// The square of the distance between two places.
inline double distance2(const TreePoint& a, const TreePoint& b) noexcept {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/// Returns the place with coordinates rounded to multiples of 2^-40. Directions that are the same but for rounding get one
/// place, so ties are ties on every processor and under every standard library.
/// Precondition: coordinates lie within [-1024, 1024].
inline TreePoint on_grid(TreePoint place) noexcept {
  // The sum's last bit is 2^-40, so the addition rounds to it.
  constexpr double kShift = 1.5 * 4096;
  for (double& x : place) x = (x + kShift) - kShift;
  return place;
}

/// Points in an order that makes neighbours quick to find: a balanced k-d tree without pointers. The middle point of a
/// range splits it along the longest side of its box; ranges of up to kLeaf points are searched one by one. The order
/// depends on the points alone, not on the standard library: ties keep the order of the input.
class KdTree {
 public:
  static constexpr std::size_t kLeaf = 8;

  /// A point that was found: the square of its distance, and its place in the tree's order.
  struct Neighbour {
    double distance2;
    std::size_t place;

    friend bool operator<(const Neighbour& a, const Neighbour& b) noexcept {
      return std::pair(a.distance2, a.place) < std::pair(b.distance2, b.place);
    }
  };

  KdTree() = default;
  explicit KdTree(std::span<const TreePoint> points);

  std::size_t size() const noexcept { return points_.size(); }
  /// The points in the tree's order, and what index each had in the input.
  std::span<const TreePoint> points() const noexcept { return points_; }
  std::span<const std::size_t> order() const noexcept { return order_; }

  /// Calls visit(place, distance2) for every point within the square of the radius.
  template <class Visit>
  void visit_ball(const TreePoint& centre, double radius2, const Visit& visit) const noexcept {
    visit_ball(0, points_.size(), centre, radius2, visit);
  }

  /// Finds the nearest points that `takes(place)` accepts, at most found.size(), and returns how many these are.
  /// They stand in `found` in no particular order. Precondition: found is not empty.
  template <class Takes>
  std::size_t nearest(const TreePoint& centre, std::span<Neighbour> found,
                      const Takes& takes) const noexcept {
    Heap heap{found, 0};
    visit_nearest(0, points_.size(), centre, heap, takes);
    return heap.count;
  }

 private:
  /// The nearest points so far, the farthest of them first.
  struct Heap {
    std::span<Neighbour> places;
    std::size_t count;

    bool full() const noexcept { return count == places.size(); }
    bool reaches(double distance2) const noexcept { return !full() || distance2 <= places[0].distance2; }
    void add(const Neighbour& next) noexcept {
      const auto end = [&] { return places.begin() + static_cast<std::ptrdiff_t>(count); };
      if (!full()) {
        places[count++] = next;
        std::push_heap(places.begin(), end());
      } else if (next < places[0]) {
        std::pop_heap(places.begin(), end());
        places[count - 1] = next;
        std::push_heap(places.begin(), end());
      }
    }
  };

  template <class Visit>
  void visit_ball(std::size_t begin, std::size_t end, const TreePoint& centre, double radius2,
                  const Visit& visit) const noexcept {
    while (end - begin > kLeaf) {
      const std::size_t middle = begin + (end - begin) / 2;
      // the pivot itself, then the far side of its plane if the ball reaches it
      const double d2 = distance2(points_[middle], centre);
      if (d2 <= radius2) visit(middle, d2);
      const double across = centre[axes_[middle]] - points_[middle][axes_[middle]];
      const bool both = across * across <= radius2;
      if (both)
        visit_ball(across < 0 ? middle + 1 : begin, across < 0 ? end : middle, centre, radius2, visit);
      // the centre's side goes on
      if (across < 0)
        end = middle;
      else
        begin = middle + 1;
    }
    for (std::size_t i = begin; i < end; ++i) {
      const double d2 = distance2(points_[i], centre);
      if (d2 <= radius2) visit(i, d2);
    }
  }

  template <class Takes>
  void visit_nearest(std::size_t begin, std::size_t end, const TreePoint& centre, Heap& heap,
                     const Takes& takes) const noexcept {
    const auto add = [&](std::size_t i) {
      const Neighbour next{distance2(points_[i], centre), i};
      if (heap.reaches(next.distance2) && takes(i)) heap.add(next);
    };
    if (end - begin <= kLeaf) {
      for (std::size_t i = begin; i < end; ++i) add(i);
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    add(middle);
    // The centre's side of the plane first, the far side only if it may still hold a nearer point.
    const double across = centre[axes_[middle]] - points_[middle][axes_[middle]];
    const bool below = across < 0;
    visit_nearest(below ? begin : middle + 1, below ? middle : end, centre, heap, takes);
    if (heap.reaches(across * across))
      visit_nearest(below ? middle + 1 : begin, below ? end : middle, centre, heap, takes);
  }

  std::vector<TreePoint> points_;
  std::vector<std::size_t> order_;
  std::vector<std::uint8_t> axes_;  // of the pivot at each place
};

}  // namespace burnish
