#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <burnish/math/kd_tree.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/log_covariance.h>
#include <burnish/reflectance/outliers.h>

namespace burnish {

namespace {

constexpr std::size_t kPredicting = 12, kUsual = 24, kFewest = 2 * kUsual;
constexpr double kDeviations = 5;
constexpr double kMedianSquare = 0.455;  // of a normal variable of deviation 1
constexpr double kLargestShare = 0.1;    // of the nodes
constexpr int kRounds = 8;
constexpr std::size_t kNodesTogether = 256;  // a thread at a time

using FewSquare =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kPredicting, kPredicting>;
using FewColumn = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kPredicting, 1>;

double covariance_between(const LogCovariance& covariance, const TreePoint& a, const TreePoint& b) noexcept {
  double sum = covariance.level * covariance.level;
  for (std::size_t t = 0; t < LogCovariance::kTerms; ++t) {
    double r2 = 0;
    for (std::size_t k = 0; k < LogCovariance::kAxes; ++k) {
      const double d = (a[k] - b[k]) * covariance.inverse_length[t][k];
      r2 += d * d;
    }
    const double r = LogCovariance::kRoot3 * std::sqrt(r2);
    sum += covariance.spread[t] * covariance.spread[t] * (1 + r) * std::exp(-r);
  }
  return sum;
}

/// Nodes in the order of a tree, and how much each of them surprises the others.
class Surprises {
 public:
  explicit Surprises(const MeasuredNodes& nodes)
      : covariance_(nodes.samples.isotropic), channels_(nodes.samples.channels) {
    std::vector<std::size_t> all;
    std::vector<TreePoint> places;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const DirectionPair& pair = nodes.samples.pairs[i];
      if (!(std::min(pair.wi.z, pair.wo.z) > KrigedNodes::kLeastCosine)) continue;
      all.push_back(i);
      places.push_back(place_of(pair.wi, pair.wo, nodes.samples.isotropic));
      for (std::size_t k = 0; k < LogCovariance::kAxes; ++k)
        places.back()[k] *= covariance_.inverse_length.back()[k];
    }
    tree_ = KdTree(places);
    for (const std::size_t place : tree_.order()) {
      node_.push_back(all[place]);
      const DirectionPair& pair = nodes.samples.pairs[node_.back()];
      places_.push_back(place_of(pair.wi, pair.wo, nodes.samples.isotropic));
      for (const double f : nodes.samples.at(node_.back()))
        logs_.push_back(std::log(std::max(0.0, f) + KrigedNodes::kFloor));
    }
    squares_.resize(size());
    out_.resize(size());
  }

  std::size_t size() const noexcept { return node_.size(); }

  /// Leaves out what contradicts its neighbours most, and says whether there was any.
  bool leave_out_more() {
    update();
    std::vector<std::uint8_t> suspect(size());
    for_each_chunk(size(), kNodesTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) suspect[i] = !out_[i] && contradicts(i) ? 1 : 0;
    });
    std::vector<std::size_t> worst;
    for (std::size_t i = 0; i < size(); ++i)
      if (suspect[i] && is_worst_nearby(i)) worst.push_back(i);
    for (const std::size_t i : worst) out_[i] = 1;
    for (const std::size_t i : worst)
      for (const KdTree::Neighbour& near : nearest<kUsual>(i)) stale_.push_back(near.place);
    return !worst.empty();
  }

  /// The nodes' own numbers, rising.
  std::vector<std::size_t> left_out() const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < size(); ++i)
      if (out_[i]) numbers.push_back(node_[i]);
    std::ranges::sort(numbers);
    return numbers;
  }

 private:
  /// The nearest others that are not left out, nearest first.
  template <std::size_t kCount>
  std::vector<KdTree::Neighbour> nearest(std::size_t i) const {
    std::vector<KdTree::Neighbour> found(kCount);
    found.resize(tree_.nearest(tree_.points()[i], found,
                               [&](std::size_t place) { return place != i && !out_[place]; }));
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Of all nodes at first, then of those near what was left out.
  void update() {
    if (!known_) {
      stale_.resize(size());
      for (std::size_t i = 0; i < size(); ++i) stale_[i] = i;
      known_ = true;
    }
    std::ranges::sort(stale_);
    const auto repeated = std::ranges::unique(stale_);
    stale_.erase(repeated.begin(), repeated.end());
    for_each_chunk(stale_.size(), kNodesTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) squares_[stale_[k]] = surprise_of(stale_[k]);
    });
    stale_.clear();
  }

  /// The square of the difference between a node's logarithm and its prediction, over the variance of both; the mean
  /// over the channels.
  double surprise_of(std::size_t i) const {
    const std::vector<KdTree::Neighbour> near = nearest<kPredicting>(i);
    const auto n = static_cast<Eigen::Index>(near.size());
    const double noise2 = covariance_.noise * covariance_.noise;
    FewSquare matrix(n, n);
    FewColumn towards(n);
    const auto place = [&](Eigen::Index k) -> const TreePoint& {
      return places_[near[static_cast<std::size_t>(k)].place];
    };
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = 0; b < a; ++b) matrix(a, b) = covariance_between(covariance_, place(a), place(b));
      matrix(a, a) = covariance_.variance() + noise2;
      towards[a] = covariance_between(covariance_, place(a), places_[i]);
    }
    const Eigen::LLT<FewSquare, Eigen::Lower> factor(matrix);
    const FewColumn weights = factor.solve(towards);
    const double variance = std::max(noise2, covariance_.variance() + noise2 - weights.dot(towards));
    double sum = 0;
    for (std::size_t c = 0; c < channels_; ++c) {
      // the mean of the neighbours is what the logarithms spread about
      double mean = 0, predicted = 0;
      for (Eigen::Index k = 0; k < n; ++k) mean += log_of(near[static_cast<std::size_t>(k)].place, c);
      mean /= static_cast<double>(n);
      for (Eigen::Index k = 0; k < n; ++k)
        predicted += weights[k] * (log_of(near[static_cast<std::size_t>(k)].place, c) - mean);
      const double off = log_of(i, c) - mean - predicted;
      sum += off * off;
    }
    return sum / (static_cast<double>(channels_) * variance);
  }

  double log_of(std::size_t place, std::size_t channel) const noexcept {
    return logs_[place * channels_ + channel];
  }

  bool contradicts(std::size_t i) const {
    constexpr double kMost = kDeviations * kDeviations;
    if (!(squares_[i] > kMost)) return false;
    std::vector<double> around;
    for (const KdTree::Neighbour& near : nearest<kUsual>(i)) around.push_back(squares_[near.place]);
    std::ranges::nth_element(around, around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2));
    return squares_[i] > kMost * around[around.size() / 2] / kMedianSquare;
  }

  bool is_worst_nearby(std::size_t i) const {
    return std::ranges::none_of(nearest<kPredicting>(i), [&](const KdTree::Neighbour& near) {
      return std::pair(squares_[near.place], near.place) > std::pair(squares_[i], i);
    });
  }

  LogCovariance covariance_;
  std::size_t channels_;
  KdTree tree_;
  std::vector<std::size_t> node_;  // everything in the tree's order
  std::vector<TreePoint> places_;  // not scaled
  std::vector<double> logs_;       // [node][channel]
  std::vector<double> squares_;
  std::vector<std::uint8_t> out_;
  std::vector<std::size_t> stale_;
  bool known_ = false;
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
