#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/metrics/node_figures.h>

namespace burnish {

namespace {

constexpr std::uint32_t kManyGroups = 20'000;
constexpr int kMaxSteps = 2;
constexpr int kFolds = 4;
// Where a node is left out the gap has twice the area of that between nodes, and there are 3/4 as many nodes: what is
// right there is too stiff between all nodes. Integrals of squared second derivatives grow with the fourth power of
// the length, the square of the area.
constexpr double kGap = (2.0 * kFolds / (kFolds - 1)) * (2.0 * kFolds / (kFolds - 1));

// Fewer places than SmoothedNodes has: as many as tell what smoothness is right.
constexpr NodeVolume kTrialVolume{24, 16, 6};
// Incidences are left out where an instrument stood at few; two of a hand are this far apart.
constexpr std::size_t kMinIncidences = 5, kMaxIncidences = 24, kIncidenceHands = 3;

/// Weighted sums of errors, to be means.
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

// The hand that a group is dealt to, as if by chance: groups in a row must not make patterns.
std::size_t hand_of(std::uint32_t group, std::size_t hands) {
  return static_cast<std::size_t>(Pcg32(group).uniform() * static_cast<double>(hands));
}

// Figures at the nodes of each hand as predicted from those of the others; what is in no hand is always seen.
template <class Hand>
NodeFigures held_out(const MeasuredNodes& nodes, const NodeSmoothness& smoothness, std::size_t hands,
                     Hand hand) {
  std::vector<ErrorSums> sums(hands);
  for_each_chunk(hands, 1, [&](std::size_t fold, std::size_t, std::size_t) {
    std::vector<std::size_t> seen, unseen;
    for (std::size_t i = 0; i < nodes.size(); ++i) (hand(i) == fold ? unseen : seen).push_back(i);
    if (unseen.empty() || seen.empty()) return;
    sums[fold] =
        sums_of(select(nodes, unseen), SmoothedNodes(select(nodes, seen), smoothness, kTrialVolume), {});
  });
  ErrorSums total;
  for (const ErrorSums& sum : sums) total.add(sum);
  return total.means({});
}

NodeSmoothness scaled(NodeSmoothness smoothness, double factor) {
  for (double& share : smoothness.shares) share *= factor;
  return smoothness;
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

NodeFigures held_out_figures(const MeasuredNodes& nodes, const NodeSmoothness& smoothness, int folds) {
  const auto hands = static_cast<std::size_t>(folds);
  return held_out(nodes, smoothness, hands, [&](std::size_t i) { return hand_of(nodes.groups[i], hands); });
}

std::optional<NodeFigures> held_out_incidences(const MeasuredNodes& nodes, const NodeSmoothness& smoothness) {
  std::vector<std::uint32_t> there(nodes.incidence);
  std::ranges::sort(there);
  there.erase(std::unique(there.begin(), there.end()), there.end());
  if (there.size() < kMinIncidences || there.size() > kMaxIncidences) return {};
  return held_out(nodes, smoothness, kIncidenceHands, [&](std::size_t i) {
    const auto place =
        static_cast<std::size_t>(std::ranges::lower_bound(there, nodes.incidence[i]) - there.begin());
    return place == 0 || place + 1 == there.size() ? kIncidenceHands : place % kIncidenceHands;
  });
}

NodeSmoothness choose_node_smoothness(const MeasuredNodes& nodes,
                                      const std::function<void(double)>& progress) {
  // enough of the groups
  std::optional<MeasuredNodes> part;
  if (const std::uint32_t step = nodes.group_count() / kManyGroups + 1; step > 1) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes.groups[i] % step == 0) chosen.push_back(i);
    part = select(nodes, chosen);
  }

  NodeSmoothness best = scaled(NodeSmoothness{}, kGap);
  // of each walk a step either way
  const double expected = 1 + 2 * (1 + static_cast<double>(best.shares.size()));
  double trials = 0;
  const auto error_of = [&](const NodeSmoothness& trial) {
    if (progress) progress(std::min(trials++ / expected, 1.0));
    const MeasuredNodes& all = part ? *part : nodes;
    const auto error = [](const NodeFigures& figures) {
      return std::log(figures.relative) + std::log(figures.log_cos);
    };
    const auto between = held_out_incidences(all, trial);
    return error(held_out_figures(all, trial, kFolds)) + (between ? error(*between) : 0.0);
  };
  double smallest = error_of(best);
  const auto improves = [&](const NodeSmoothness& trial) {
    const double error = error_of(trial);
    if (!(error < smallest)) return false;
    smallest = error;
    best = trial;
    return true;
  };
  // all shares, or one, up or down as long as that helps
  const auto walk = [&](auto changed) {
    for (const double factor : {10.0, 0.1}) {
      int steps = 0;
      while (steps < kMaxSteps && improves(changed(best, factor))) ++steps;
      if (steps > 0) break;  // the other way would undo it
    }
  };
  walk(scaled);
  for (std::size_t k = 0; k < best.shares.size(); ++k)
    walk([k](NodeSmoothness trial, double factor) {
      trial.shares[k] *= factor;
      return trial;
    });
  return scaled(best, 1 / kGap);
}

}  // namespace burnish
