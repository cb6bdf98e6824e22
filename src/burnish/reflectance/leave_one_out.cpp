// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <burnish/math/parallel.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/leave_one_out.h>
#include <burnish/reflectance/scattered_brdf.h>

namespace burnish {

namespace {

constexpr std::size_t kMostAsked = 2000, kMostPredicting = 50'000, kAskedTogether = 64;
constexpr double kFarthest = 1;  // largest difference of logarithms that counts

constexpr auto kFew = static_cast<int>(LeaveOneOut::kPredicting);
using FewSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kFew, kFew>;
using FewColumn = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kFew, 1>;

}  // namespace

LeaveOneOut::LeaveOneOut(const Samples& samples, bool isotropic)
    : covariance_(isotropic), channels_(samples.channels) {
  std::vector<std::size_t> all;
  std::vector<TreePoint> places, scaled;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const DirectionPair& pair = samples.pairs[i];
    if (!(std::min(pair.wi.z, pair.wo.z) > KrigedNodes::kLeastCosine)) continue;
    all.push_back(i);
    places.push_back(place_of(pair.wi, pair.wo, isotropic));
    scaled.push_back(places.back());
    for (std::size_t k = 0; k < LogCovariance::kAxes; ++k)
      scaled.back()[k] *= covariance_.inverse_length.back()[k];
  }
  // All arrays are in the tree's order.
  tree_ = KdTree(scaled);
  for (const std::size_t i : tree_.order()) {
    number_.push_back(all[i]);
    places_.push_back(places[i]);
    for (const double f : samples.at(all[i]))
      logs_.push_back(std::log(std::max(0.0, f) + KrigedNodes::kFloor));
  }
}

std::vector<KdTree::Neighbour> LeaveOneOut::nearest(std::size_t i, std::size_t count,
                                                    std::span<const std::uint8_t> left_out) const {
  std::vector<KdTree::Neighbour> found(count);
  found.resize(tree_.nearest(tree_.points()[i], found, [&](std::size_t place) {
    return place != i && (left_out.empty() || !left_out[place]);
  }));
  std::sort(found.begin(), found.end());
  return found;
}

LeaveOneOut::Miss LeaveOneOut::miss(std::size_t i, std::span<const std::uint8_t> left_out) const {
  // K holds the covariances of the neighbours with each other and their noise, k those with the sample.
  const std::vector<KdTree::Neighbour> near = nearest(i, kPredicting, left_out);
  const auto n = static_cast<Eigen::Index>(near.size());
  const double noise2 = covariance_.noise * covariance_.noise;
  FewSquare matrix(n, n);
  FewColumn towards(n);
  const auto place = [&](Eigen::Index k) -> const TreePoint& {
    return places_[near[static_cast<std::size_t>(k)].place];
  };
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) matrix(a, b) = covariance_.between(place(a), place(b));
    matrix(a, a) = covariance_.variance() + noise2;
    towards[a] = covariance_.between(place(a), places_[i]);
  }
  // The weights are K^-1 k, and the variance of the difference is k(x, x) + noise - k^T K^-1 k [Rasmussen 2006, eq.
  // 2.26].
  const Eigen::LLT<FewSquare, Eigen::Lower> factor(matrix);
  const FewColumn weights = factor.solve(towards);
  const double variance = std::max(noise2, covariance_.variance() + noise2 - weights.dot(towards));

  // Logarithms are predicted about the mean of the neighbours [Rasmussen 2006, eq. 2.25].
  Miss miss;
  for (std::size_t c = 0; c < channels_; ++c) {
    double mean = 0, predicted = 0;
    for (const KdTree::Neighbour& one : near) mean += log_of(one.place, c) / static_cast<double>(near.size());
    for (std::size_t k = 0; k < near.size(); ++k)
      predicted += weights[static_cast<Eigen::Index>(k)] * (log_of(near[k].place, c) - mean);
    const double off = log_of(i, c) - mean - predicted;
    miss.square += off * off / (static_cast<double>(channels_) * variance);
    miss.distance += std::abs(off) / static_cast<double>(channels_);
  }
  return miss;
}

namespace {

double mean_distance(const Samples& samples, bool isotropic) {
  const LeaveOneOut others(samples, isotropic);
  if (others.size() < 2 * LeaveOneOut::kPredicting) return 0;
  // Every step-th sample is predicted, so that at most kMostAsked are.
  const std::size_t step = (others.size() - 1) / kMostAsked + 1, asked = (others.size() - 1) / step + 1;
  std::vector<double> distances(asked);
  for_each_chunk(asked, kAskedTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      distances[k] = std::min(kFarthest, others.miss(k * step).distance);
  });
  double sum = 0;
  for (const double distance : distances) sum += distance;
  return sum / static_cast<double>(asked);
}

}  // namespace

IsotropyErrors isotropy_errors(const Samples& samples) {
  const std::size_t step = samples.size() / kMostPredicting + 1;
  if (step == 1) return {mean_distance(samples, true), mean_distance(samples, false)};
  std::vector<std::size_t> part;
  for (std::size_t i = 0; i < samples.size(); i += step) part.push_back(i);
  const Samples some = select(samples, part);
  return {mean_distance(some, true), mean_distance(some, false)};
}

}  // namespace burnish
