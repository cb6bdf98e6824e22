// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <burnish/fitting/choosing/fetch_plan.h>
#include <burnish/fitting/choosing/volume_smoothness.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

namespace {

constexpr double kFirstSmooth = 1e-7, kMinSmooth = 1e-9, kMaxVolumeSmooth = 1e-4, kStep = 10;
// Each of half of the nodes has twice the area; integrals of squared second derivatives grow with the square of the
// area.
constexpr double kGap = 4;
// The terms of a model's shares that count nodes; here no other terms are used.
constexpr ErrorTerms kShares{.pictures = 0, .dimmed = 0, .relative = 2, .log_cos = 2};
constexpr std::size_t kMaxNodes = 40'000;
constexpr double kFullCosine = 0.15;  // from here on nodes count fully, as in KrigedNodes

MeasuredNodes part_of_many(const MeasuredNodes& nodes) {
  const auto step = static_cast<std::uint32_t>(nodes.size() / kMaxNodes + 1);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes.groups[i] % step == 0) chosen.push_back(i);
  return select(nodes, chosen);
}

/// One half of the nodes as pairs to fit, and the other to score.
struct Trial {
  TrainingSet seen;
  MeasuredNodes unseen;
};

Trial trial_of(const MeasuredNodes& nodes, std::uint32_t half, bool symmetrize) {
  const MeasuredNodes fitted = nodes_of(nodes, {.kind = NodePart::Kind::half, .number = half});
  Trial trial{.seen = training_set_of(fitted.samples, symmetrize),
              .unseen = nodes_without(nodes, {.kind = NodePart::Kind::half, .number = half})};
  // Each node counts once, or once for either order of the directions.
  for (std::size_t i = 0; i < trial.seen.size(); ++i) {
    const DirectionPair& pair = trial.seen.pairs[i];
    trial.seen.weights[i] = static_cast<float>(fitted.weights[i % fitted.size()] *
                                               std::min(1.0, std::min(pair.wi.z, pair.wo.z) / kFullCosine));
  }
  return trial;
}

}  // namespace

double choose_volume_smoothness(const MeasuredNodes& nodes, const ModelSpec& spec, bool symmetrize) {
  const MeasuredNodes part = part_of_many(nodes);
  const std::array<Trial, 2> trials{trial_of(part, 0, symmetrize), trial_of(part, 1, symmetrize)};
  const std::vector<ModelSpec> specs{spec};
  const auto error_of = [&](double smooth) {
    std::array<double, 2> errors{};
    for_each_chunk(trials.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
      const LobesFit fit = fit_volumes(trials[k].seen, specs, {.shares = kShares, .smooth = smooth});
      const FactoredBrdf brdf = to_brdf(fit.model, TableFormat::half);
      const NodeFigures figures = node_figures(trials[k].unseen, brdf);
      errors[k] = std::log(figures.relative) + std::log(figures.log_cos);
    });
    return errors[0] + errors[1];
  };

  // The smoothness goes up or down as long as that helps.
  double best = kFirstSmooth, smallest = error_of(best);
  for (const double factor : {kStep, 1 / kStep}) {
    const double from = best;
    for (double smooth = best * factor; smooth > 0.5 * kMinSmooth && smooth < 2 * kMaxVolumeSmooth;
         smooth *= factor) {
      const double error = error_of(smooth);
      if (!(error < smallest)) break;
      smallest = error;
      best = smooth;
    }
    if (best != from) break;  // the other direction would undo it
  }
  return best / kGap;
}

}  // namespace burnish
