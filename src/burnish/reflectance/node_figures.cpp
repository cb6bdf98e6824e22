// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

namespace {

constexpr std::size_t kMostJudged = 1000;    // nodes
constexpr std::size_t kJudgedTogether = 64;  // of these, so many for each thread at a time

// Incidences are held out where an instrument stood at few. Two of one fold are kIncidenceHands apart.
constexpr std::size_t kMinIncidences = 5, kMaxIncidences = 24, kIncidenceHands = 3;

/// Weighted sums of errors, which become means.
struct ErrorSums {
  double log_cos = 0, log_ratio = 0, log_ratio_sq = 0, difference_sq = 0, weight = 0;
  std::size_t count = 0;

  void add(const PairError& error, double by) noexcept {
    log_cos += by * error.log_cos;
    log_ratio += by * error.log_ratio;
    log_ratio_sq += by * error.log_ratio_sq;
    difference_sq += by * error.difference_sq;
    weight += by;
    ++count;
  }
  void add(const ErrorSums& other) noexcept {
    log_cos += other.log_cos;
    log_ratio += other.log_ratio;
    log_ratio_sq += other.log_ratio_sq;
    difference_sq += other.difference_sq;
    weight += other.weight;
    count += other.count;
  }
  NodeFigures means(const NodeScoring& scoring) const {
    if (count == 0)
      throw Error(
          fmt::format("nodes: expected some with both cosines above {}, found none", scoring.least_cosine));
    return {log_cos / weight, std::expm1(log_ratio / weight), std::sqrt(log_ratio_sq / weight),
            std::sqrt(difference_sq / weight), count};
  }
};

/// Calls body(node, error) for the nodes that are scored.
template <class Body>
void for_each_error(const MeasuredNodes& nodes, BrdfRef model, const NodeScoring& scoring, Body body) {
  const std::size_t channels = nodes.samples.channels;
  if (model.channels() != channels && model.channels() != 1 && channels != 1)
    throw Error(
        fmt::format("cannot compare nodes of {} channels with a model of {}", channels, model.channels()));
  std::vector<double> f(model.channels());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const DirectionPair& pair = nodes.samples.pairs[i];
    if (!(std::min(pair.wi.z, pair.wo.z) > scoring.least_cosine) || !model.eval(pair.wi, pair.wo, f))
      continue;
    body(i, pair_error(pair, nodes.samples.at(i), f, scoring.floor));
  }
}

ErrorSums sums_of(const MeasuredNodes& nodes, BrdfRef model, const NodeScoring& scoring) {
  ErrorSums sums;
  for_each_error(nodes, model, scoring,
                 [&](std::size_t i, const PairError& error) { sums.add(error, nodes.weights[i]); });
  return sums;
}

// Returns the fold of a group, at random but the same each time: consecutive groups must not make patterns.
std::size_t hand_of(std::uint32_t group, std::size_t hands) {
  return static_cast<std::size_t>(Pcg32(group).uniform() * static_cast<double>(hands));
}

// Returns the errors at nodes as predicted from the other folds (cross-validation). Nodes in no fold always take part
// in predictions.
template <class Hand>
ErrorSums held_out(const MeasuredNodes& nodes, const LogCovariance& covariance, std::size_t hands,
                   Hand hand) {
  // Every step-th node that is in a fold and may be scored is predicted, at most kMostJudged of them.
  std::vector<std::size_t> judged;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const DirectionPair& pair = nodes.samples.pairs[i];
    if (hand(i) < hands && std::min(pair.wi.z, pair.wo.z) > NodeScoring{}.least_cosine) judged.push_back(i);
  }
  const std::size_t step = judged.size() > kMostJudged ? (judged.size() + kMostJudged - 1) / kMostJudged : 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < judged.size(); i += step) judged[kept++] = judged[i];
  judged.resize(kept);

  const KrigedNodes function(nodes, covariance, true);
  std::vector<ErrorSums> sums(chunk_count(judged.size(), kJudgedTogether));
  for_each_chunk(judged.size(), kJudgedTogether, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::vector<double> f(nodes.samples.channels);
    for (std::size_t j = begin; j < end; ++j) {
      const std::size_t i = judged[j];
      const DirectionPair& pair = nodes.samples.pairs[i];
      function.eval_from(
          pair.wi, pair.wo, [&, own = hand(i)](std::size_t other) { return hand(other) != own; }, f);
      sums[chunk].add(pair_error(pair, nodes.samples.at(i), f, NodeScoring{}.floor), nodes.weights[i]);
    }
  });
  ErrorSums total;
  for (const ErrorSums& sum : sums) total.add(sum);
  return total;
}

bool any_is_scored(const MeasuredNodes& nodes) {
  return std::ranges::any_of(nodes.samples.pairs, [](const DirectionPair& pair) {
    return std::min(pair.wi.z, pair.wo.z) > NodeScoring{}.least_cosine;
  });
}

}  // namespace

std::vector<PairError> node_errors(const MeasuredNodes& nodes, BrdfRef model, const NodeScoring& scoring) {
  std::vector<PairError> errors;
  for_each_error(nodes, model, scoring,
                 [&](std::size_t, const PairError& error) { errors.push_back(error); });
  return errors;
}

NodeFigures node_figures(const MeasuredNodes& nodes, BrdfRef model, const NodeScoring& scoring) {
  return sums_of(nodes, model, scoring).means(scoring);
}

NodeFigures held_out_figures(const MeasuredNodes& nodes, const LogCovariance& covariance, int folds) {
  const auto hands = static_cast<std::size_t>(folds);
  return held_out(nodes, covariance, hands, [&](std::size_t i) { return hand_of(nodes.groups[i], hands); })
      .means({});
}

std::optional<NodeFigures> held_out_incidences(const MeasuredNodes& nodes, const LogCovariance& covariance) {
  // Each incidence but the first and the last is one of three folds in turn, so its neighbours on both sides stay.
  std::vector<std::uint32_t> there(nodes.incidence);
  std::ranges::sort(there);
  there.erase(std::unique(there.begin(), there.end()), there.end());
  if (there.size() < kMinIncidences || there.size() > kMaxIncidences) return {};
  std::vector<std::size_t> hand_of_incidence(there.back() + 1, kIncidenceHands);
  for (std::size_t place = 1; place + 1 < there.size(); ++place)
    hand_of_incidence[there[place]] = place % kIncidenceHands;
  const ErrorSums sums = held_out(nodes, covariance, kIncidenceHands,
                                  [&](std::size_t i) { return hand_of_incidence[nodes.incidence[i]]; });
  if (sums.count == 0) return {};  // all incidences in folds lie along the horizon
  return sums.means({});
}

LogCovariance choose_covariance(const MeasuredNodes& nodes, const std::function<void(double)>& progress) {
  if (!any_is_scored(nodes)) return LogCovariance(nodes.samples.isotropic);
  std::vector<LogCovariance> likely = likely_covariances(nodes);
  likely.push_back(LogCovariance(nodes.samples.isotropic));
  // The covariance with the least sum of log errors wins: at held-out nodes and, if there are such, at held-out
  // incidences.
  const auto error_of = [&](const LogCovariance& covariance) {
    const auto error = [](const NodeFigures& figures) {
      return std::log(figures.relative) + std::log(figures.log_cos);
    };
    const auto between = held_out_incidences(nodes, covariance);
    return error(held_out_figures(nodes, covariance)) + (between ? error(*between) : 0.0);
  };
  std::size_t best = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < likely.size(); ++i) {
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(likely.size() + 1));
    const double error = error_of(likely[i]);
    if (!(error < smallest)) continue;
    smallest = error;
    best = i;
  }
  return likely[best];
}

}  // namespace burnish
