// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include <burnish/math/parallel.h>
#include <burnish/math/vec3.h>
#include <burnish/reflectance/leave_one_out.h>
#include <burnish/reflectance/outliers.h>

namespace burnish {

namespace {

constexpr std::size_t kUsual = 24, kFewest = 2 * kUsual;
constexpr double kDeviations = 5;
constexpr double kLeastFactor = 2;  // between an outlier and what its neighbours predict
constexpr std::size_t kNearerHorizon = kUsual / 4, kNearerMirror = kUsual / 8,
                      kNearerNormal = kUsual / 8;  // at least
constexpr double kMedianSquare = 0.455;            // median square of a normal variable of deviation 1
constexpr double kLargestShare = 0.1;              // of the nodes
constexpr int kRounds = 8;
constexpr std::size_t kNodesTogether = 256;  // a thread at a time

/// Nodes and the standardized square of each one's prediction error.
class Surprises {
 public:
  explicit Surprises(const MeasuredNodes& nodes)
      : others_(nodes.samples, nodes.samples.isotropic),
        squares_(others_.size()),
        distances_(others_.size()),
        out_(others_.size()) {
    for (std::size_t i = 0; i < others_.size(); ++i) {
      const DirectionPair& pair = nodes.samples.pairs[others_.number(i)];
      const std::span<const double> f = nodes.samples.at(others_.number(i));
      // Cosines are compared, and those of one angle are to be equal whatever their last bits say.
      const TreePoint cosines = on_grid({half_vector(pair.wi, pair.wo).z, std::min(pair.wi.z, pair.wo.z),
                                         std::max(pair.wi.z, pair.wo.z), 0});
      cosine_of_h_.push_back(cosines[0]);
      least_cosine_.push_back(cosines[1]);
      largest_cosine_.push_back(cosines[2]);
      sum_.push_back(std::accumulate(f.begin(), f.end(), 0.0));
      stale_.push_back(i);
    }
  }

  std::size_t size() const noexcept { return others_.size(); }

  /// Leaves out the nodes that contradict their neighbours most. Returns true if there were any.
  bool leave_out_more() {
    update();
    std::vector<std::uint8_t> suspect(size());
    for_each_chunk(size(), kNodesTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) suspect[i] = !out_[i] && contradicts(i) ? 1 : 0;
    });
    std::vector<std::size_t> worst;
    for (std::size_t i = 0; i < size(); ++i)
      if (suspect[i] && is_worst_nearby(i)) worst.push_back(i);
    // A node that is left out changes the predictions of those near it.
    for (const std::size_t i : worst) out_[i] = 1;
    for (const std::size_t i : worst)
      for (const KdTree::Neighbour& near : others_.nearest(i, kUsual, out_)) stale_.push_back(near.place);
    return !worst.empty();
  }

  /// Returns the numbers of the nodes left out, rising.
  std::vector<std::size_t> left_out() const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < size(); ++i)
      if (out_[i]) numbers.push_back(others_.number(i));
    std::ranges::sort(numbers);
    return numbers;
  }

 private:
  /// Updates the squares: those of all nodes at first, later those near a node that was left out.
  void update() {
    std::ranges::sort(stale_);
    stale_.erase(std::unique(stale_.begin(), stale_.end()), stale_.end());
    for_each_chunk(stale_.size(), kNodesTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const LeaveOneOut::Miss miss = others_.miss(stale_[k], out_);
        squares_[stale_[k]] = miss.square;
        distances_[stale_[k]] = miss.distance;
      }
    });
    stale_.clear();
  }

  bool contradicts(std::size_t i) const {
    // An outlier is more than five deviations and a factor of two off, and five times more than is usual around it: the
    // median of the neighbours' squares over that of a normal variable is their usual variance. Real sources have narrow
    // bumps that are smaller.
    constexpr double kMost = kDeviations * kDeviations;
    if (!(squares_[i] > kMost && distances_[i] > std::log(kLeastFactor))) return false;
    const std::vector<KdTree::Neighbour> near = others_.nearest(i, kUsual, out_);
    if (!is_surrounded(i, near) || !is_extreme(i, near)) return false;
    std::vector<double> around;
    for (const KdTree::Neighbour& one : near) around.push_back(squares_[one.place]);
    std::ranges::nth_element(around, around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2));
    return squares_[i] > kMost * around[around.size() / 2] / kMedianSquare;
  }

  /// Returns true if the others stand on all sides. A rise towards the horizon, the mirror direction or the normal, where
  /// measurements end, differs from all that was measured before it.
  bool is_surrounded(std::size_t i, std::span<const KdTree::Neighbour> near) const {
    const auto count = [&](const auto& is_beyond) {
      return static_cast<std::size_t>(
          std::ranges::count_if(near, [&](const KdTree::Neighbour& one) { return is_beyond(one.place); }));
    };
    return count([&](std::size_t k) { return least_cosine_[k] < least_cosine_[i]; }) >= kNearerHorizon &&
           count([&](std::size_t k) { return cosine_of_h_[k] > cosine_of_h_[i]; }) >= kNearerMirror &&
           count([&](std::size_t k) { return largest_cosine_[k] > largest_cosine_[i]; }) >= kNearerNormal;
  }

  /// Returns true if it is larger, or smaller, than all the others: on the slope of a highlight a value is neither.
  bool is_extreme(std::size_t i, std::span<const KdTree::Neighbour> near) const {
    const double own = sum_[i];
    return std::ranges::none_of(near, [&](const auto& one) { return sum_[one.place] <= own; }) ||
           std::ranges::none_of(near, [&](const auto& one) { return sum_[one.place] >= own; });
  }

  bool is_worst_nearby(std::size_t i) const {
    return std::ranges::none_of(
        others_.nearest(i, LeaveOneOut::kPredicting, out_), [&](const KdTree::Neighbour& near) {
          return std::pair(squares_[near.place], near.place) > std::pair(squares_[i], i);
        });
  }

  LeaveOneOut others_;
  // One value a node, in the order of others_; sum_ adds the channels.
  std::vector<double> cosine_of_h_, least_cosine_, largest_cosine_, sum_;
  std::vector<double> squares_, distances_;
  std::vector<std::uint8_t> out_;   // 1: left out
  std::vector<std::size_t> stale_;  // nodes whose squares are out of date
};

}  // namespace

std::vector<std::size_t> outliers_among(const MeasuredNodes& nodes) {
  Surprises surprises(nodes);
  if (surprises.size() < kFewest) return {};
  for (int round = 0; round < kRounds && surprises.leave_out_more(); ++round) {
  }
  std::vector<std::size_t> outliers = surprises.left_out();
  if (static_cast<double>(outliers.size()) > kLargestShare * static_cast<double>(nodes.size())) return {};
  return outliers;
}

MeasuredNodes without_outliers(MeasuredNodes nodes) {
  const std::vector<std::size_t> outliers = outliers_among(nodes);
  if (outliers.empty()) return nodes;
  std::vector<std::size_t> others;
  auto next = outliers.begin();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (next != outliers.end() && *next == i)
      ++next;
    else
      others.push_back(i);
  return select(nodes, others);
}

}  // namespace burnish
