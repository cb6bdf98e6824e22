// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/next_measurements.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

namespace {

constexpr std::size_t kTried = kMostNext, kJudged = 400;
constexpr std::uint64_t kTriedSeed = 21, kJudgedSeed = 22;
constexpr std::size_t kTriedTogether = 16;  // a thread at a time

/// Returns the first pairs of draw_pairs that node_figures would score.
std::vector<DirectionPair> pairs_to_judge(std::size_t count, std::uint64_t seed, bool isotropic) {
  std::vector<DirectionPair> pairs = draw_pairs(2 * count, seed, isotropic);
  std::erase_if(pairs, [](const DirectionPair& pair) {
    return !(std::min(pair.wi.z, pair.wo.z) > NodeScoring{}.least_cosine);
  });
  if (pairs.size() > count) pairs.resize(count);
  return pairs;
}

/// Returns the pair as an instrument turns: the light of an isotropic sample stands at azimuth 0.
DirectionPair as_instruments_turn(const DirectionPair& pair, bool isotropic) noexcept {
  if (!isotropic) return pair;
  const double turn = std::abs(std::remainder(phi_of(pair.wo) - phi_of(pair.wi), kTwoPi));
  return {spherical_direction(theta_of(pair.wi), 0), spherical_direction(theta_of(pair.wo), turn)};
}

/// Bounds a covariance by what both variances allow (Cauchy-Schwarz).
double bounded(double covariance, double variance, double other) noexcept {
  const double most = std::sqrt(variance * other);
  return std::clamp(covariance, -most, most);
}

/// Variances of the function and of noise at pairs, and the roots of their calibrations.
struct Known {
  std::vector<DirectionPair> pairs;
  std::vector<double> variances, noise, scale;

  Known(const KrigedNodes& function, std::vector<DirectionPair> of)
      : pairs(std::move(of)), variances(pairs.size()), noise(pairs.size()), scale(pairs.size()) {
    for_each_chunk(size(), kTriedTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const LogUncertainty sigma = function.uncertainty(pairs[i].wi, pairs[i].wo);
        variances[i] = sigma.function * sigma.function;
        noise[i] = sigma.reading * sigma.reading - variances[i];
        scale[i] = std::sqrt(function.calibration(pairs[i]));
      }
    });
  }
  std::size_t size() const noexcept { return pairs.size(); }
};

/// Returns covariances [row][column] of the function at pairs. Each is the smaller one of those given the nodes near
/// either pair, since more nodes leave less of it.
std::vector<double> covariances_of(const KrigedNodes& function, const Known& rows, const Known& columns) {
  const std::size_t count = columns.size();
  std::vector<double> by_row(rows.size() * count), by_column(rows.size() * count);
  for_each_chunk(rows.size(), kTriedTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      function.covariances_with(rows.pairs[r], columns.pairs, std::span(by_row).subspan(r * count, count));
  });
  for_each_chunk(count, kTriedTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      function.covariances_with(columns.pairs[c], rows.pairs,
                                std::span(by_column).subspan(c * rows.size(), rows.size()));
  });
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < count; ++c) {
      double& covariance = by_row[r * count + c];
      const double other = by_column[c * rows.size() + r];
      if (std::abs(other) < std::abs(covariance)) covariance = other;
      covariance =
          bounded(rows.scale[r] * columns.scale[c] * covariance, rows.variances[r], columns.variances[c]);
    }
  return by_row;
}

/// The expected errors of pairs that may be measured, and of those at which errors count, while pairs are chosen.
class Expectation {
 public:
  Expectation(const KrigedNodes& function, bool isotropic)
      : tried_(function, pairs_to_judge(kTried, kTriedSeed, isotropic)),
        judged_(function, pairs_to_judge(kJudged, kJudgedSeed, isotropic)),
        shared_(covariances_of(function, tried_, judged_)),
        among_(covariances_of(function, tried_, tried_)) {}

  std::size_t size() const noexcept { return tried_.size(); }
  const DirectionPair& pair(std::size_t c) const noexcept { return tried_.pairs[c]; }
  double error(std::size_t c) const noexcept { return std::sqrt(tried_.variances[c]); }

  /// Returns by how much a reading lowers the sum of expected errors.
  double gain(std::size_t c) const noexcept {
    // A reading at c leaves at r the variance v_r - cov(c, r)^2 / (v_c + noise_c) [Rasmussen 2006, eq. 2.26].
    const double reading = tried_.variances[c] + tried_.noise[c];
    double gain = 0;
    for (std::size_t r = 0; r < judged_.size(); ++r) {
      const double shared = shared_[c * judged_.size() + r], before = judged_.variances[r];
      gain += std::sqrt(before) - std::sqrt(std::max(0.0, before - shared * shared / reading));
    }
    return gain;
  }

  /// Conditions all variances and covariances on a reading: one step of a Cholesky factorization of the covariance of
  /// all pairs.
  void take(std::size_t chosen) {
    const double by = 1 / std::sqrt(tried_.variances[chosen] + tried_.noise[chosen]);
    const auto lowered = [](double variance, double share) {
      return std::max(0.0, variance - share * share);
    };
    std::vector<double> of_tried(tried_.size()), of_judged(judged_.size());
    for (std::size_t c = 0; c < of_tried.size(); ++c) of_tried[c] = by * among_[chosen * tried_.size() + c];
    for (std::size_t r = 0; r < of_judged.size(); ++r)
      of_judged[r] = by * shared_[chosen * judged_.size() + r];
    for (std::size_t c = 0; c < of_tried.size(); ++c)
      tried_.variances[c] = lowered(tried_.variances[c], of_tried[c]);
    for (std::size_t r = 0; r < of_judged.size(); ++r)
      judged_.variances[r] = lowered(judged_.variances[r], of_judged[r]);
    for_each_chunk(of_tried.size(), kTriedTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) {
        const double own = tried_.variances[c];
        for (std::size_t r = 0; r < of_judged.size(); ++r) {
          double& shared = shared_[c * judged_.size() + r];
          shared = bounded(shared - of_tried[c] * of_judged[r], own, judged_.variances[r]);
        }
        for (std::size_t d = 0; d < of_tried.size(); ++d) {
          double& between = among_[c * tried_.size() + d];
          between = bounded(between - of_tried[c] * of_tried[d], own, tried_.variances[d]);
        }
      }
    });
  }

 private:
  Known tried_, judged_;
  std::vector<double> shared_, among_;  // covariances, [tried][judged] and [tried][tried]
};

}  // namespace

std::vector<NextMeasurement> next_measurements(const MeasuredNodes& nodes, const LogCovariance& covariance,
                                               std::size_t count) {
  const KrigedNodes function(nodes, covariance);
  Expectation expectation(function, nodes.samples.isotropic);
  std::vector<bool> taken(expectation.size());
  std::vector<NextMeasurement> next;
  std::vector<double> gains(expectation.size());
  while (next.size() < std::min(count, expectation.size())) {
    for_each_chunk(gains.size(), kTriedTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) gains[c] = taken[c] ? -1 : expectation.gain(c);
    });
    const auto best = static_cast<std::size_t>(std::ranges::max_element(gains) - gains.begin());
    next.push_back(
        {as_instruments_turn(expectation.pair(best), nodes.samples.isotropic), expectation.error(best)});
    taken[best] = true;
    expectation.take(best);
  }
  return next;
}

}  // namespace burnish
