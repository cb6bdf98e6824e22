// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/choosing/fetch_plan.h>
#include <burnish/fitting/choosing/hemisphere_plan.h>
#include <burnish/fitting/choosing/lay_out.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/order_tables.h>
#include <burnish/fitting/choosing/volume_forms.h>
#include <burnish/fitting/numerics/node_numbers.h>

namespace burnish {

namespace {

// With fewer texels than this, lines serve better, if there are enough fetches for them.
constexpr double kMinVolumeTexels = 1200;

// Before the last refinement, fits use about this many pairs, few steps, and this share of the nodes.
constexpr std::size_t kFewVolumePairs = 24'000, kCoarseNodes = 5000;
constexpr double kCoarseShare = 0.25;
constexpr int kCoarseSteps = 10, kCoarseStepsAfterTrial = 4, kFullSteps = 6, kHeldSteps = 4,
              kManyFullSteps = 4, kManyHeldSteps = 3;
// The log-linear start counts values about zero as the relative error does. It is smooth and only roughly solved.
const HomomorphicOptions kStart{.smooth = 1e-5, .floor = PictureLoss::kFloor, .tolerance = 0.03};
// Trials use one of kVolumeTrialPart pairs and few steps. Their gains must exceed what another draw of pairs would
// give.
constexpr std::size_t kVolumeTrialPart = 8;
constexpr int kVolumeTrialSteps = 4, kLobesTrialSteps = 30;
// Progress at which trials, steps with few pairs and steps with all pairs end.
constexpr double kVolumeTrialTime = 0.1, kCoarseTime = 0.3, kFullTime = 0.8;
constexpr int kFetches[] = {2, 3, 4, 6, 8, 12, 24};

TrainingSet about(const TrainingSet& set, std::size_t pairs) {
  return thinned(set, std::max<std::size_t>(1, set.size() / pairs));
}

/// Returns the heat of models of an isotropic source.
Heat volume_heat(const TrainingSet& set, const RefineOptions& options) {
  return {.parts = TrialParts(set, kVolumeTrialPart),
          .options = in_few_steps(options, kVolumeTrialSteps),
          .shares = options.shares};
}

/// Fits a model with a volume, at as many nodes as the pairs determine.
void fit_volume(const Heat& heat, Candidate& candidate) {
  const TrainingSet& fitted = heat.parts.fitted;
  const double nodes = static_cast<double>(coupled_unknowns(candidate.spec, 1));
  const ModelSpec trial =
      at_fewer_nodes(candidate.spec, std::min(1.0, static_cast<double>(fitted.size()) / (6 * nodes)));
  candidate.fit = fit_one_lobe(trial, fitted, fitted.values, kStart);
  refine(candidate.fit, fitted, heat.options);
}

/// Returns the spec that scores best on a part of the pairs that it was not fitted to. Specs with many nodes serve
/// alike, whatever their distribution, so the first one is returned untried.
Candidate best_volume(const std::vector<ModelSpec>& specs, const TrainingSet& set,
                      const RefineOptions& options) {
  if (specs.size() == 1 || coupled_unknowns(specs.front(), 1) > kCoarseNodes) return {.spec = specs.front()};
  std::vector<Candidate> candidates;
  for (const ModelSpec& spec : specs) candidates.push_back({.spec = spec});
  const Heat heat = volume_heat(set, options);
  heat.play(
      candidates, [&](Candidate& candidate) { fit_volume(heat, candidate); },
      part_of_progress(options.progress, 0, kVolumeTrialTime));
  return std::move(winner(candidates));
}

/// Returns the candidates of try_fetches: models with several numbers of fetches that the bytes hold, each number
/// once.
std::vector<Candidate> candidates_by_fetches(BrdfRef source, CostLimit limit) {
  const LobePlan lobes = plan_for(source, limit.bytes, 0, limit.texel_bytes);
  std::vector<int> fetches(std::begin(kFetches), std::end(kFetches));
  if (plan_fits(lobes, limit.bytes, source.channels(), limit.texel_bytes))
    fetches.push_back(static_cast<int>(
        fetch_count(plan_to_spec(lobes, limit.bytes, source.channels(), limit.texel_bytes))));
  std::ranges::sort(fetches);
  const SourceTraits traits = traits_of(source);
  std::vector<Candidate> candidates;
  for (const int n : fetches) {
    limit.fetches = n;
    if (!holds_model(source, limit)) continue;
    Candidate next;
    if (takes_lobes(source, limit)) {
      next.plan = lobes;
      next.spec = plan_to_spec(lobes, limit.bytes, source.channels(), limit.texel_bytes);
    } else {
      next.spec = usual_volume_spec(limit, source.channels(),
                                    {traits.twisted, traits.ordered && n > 1, traits.retro});
    }
    if (candidates.empty() || fetch_count(candidates.back().spec) != fetch_count(next.spec))
      candidates.push_back(std::move(next));
  }
  return candidates;
}

}  // namespace

bool takes_lobes(BrdfRef source, const CostLimit& limit) {
  const bool few_bytes = static_cast<double>(limit.bytes / limit.texel_bytes) < kMinVolumeTexels;
  if (!few_bytes || !source.isotropic()) return few_bytes;
  const LobePlan plan = plan_for(source, limit.bytes, 0, limit.texel_bytes);
  return plan_fits(plan, limit.bytes, source.channels(), limit.texel_bytes) &&
         fetch_count(plan_to_spec(plan, limit.bytes, source.channels(), limit.texel_bytes)) <=
             static_cast<std::size_t>(limit.fetches);
}

bool holds_model(BrdfRef source, const CostLimit& limit) {
  if (takes_lobes(source, limit))
    return plan_fits(plan_within(source, limit), limit.bytes, source.channels(), limit.texel_bytes);
  try {
    if (source.isotropic())
      usual_volume_spec(
          limit, source.channels(),
          {.twisted = true, .ordered = limit.fetches > 1 && order_matters(source), .retro = true});
    else
      hemisphere_specs(limit, source.channels());
    return true;
  } catch (const Error&) {
    return false;
  }
}

LobePlan plan_within(BrdfRef source, const CostLimit& limit) {
  if (source.isotropic()) return plan_for(source, limit.bytes, 0, limit.texel_bytes);
  LobePlan plan = default_plan(limit.bytes, 2, false, limit.texel_bytes);
  const auto fetches = [&] {
    std::size_t sum = 0;
    for (const auto* factors : {&plan.factors, &plan.wide})
      for (const PlannedFactor& factor : *factors) sum += factor.uses.size();
    return sum;
  };
  // The least useful factors are dropped first: the wide lobe's factors except that of theta_d, and last all factors
  // except that of the half vector.
  const auto drop = [&](const char* name) {
    if (fetches() <= static_cast<std::size_t>(limit.fetches)) return;
    for (auto* factors : {&plan.factors, &plan.wide})
      std::erase_if(*factors, [&](const PlannedFactor& factor) { return factor.name == name; });
  };
  for (const char* name : {"b", "a", "m", "p", "r", "c"}) drop(name);
  if (plan.wide.empty()) plan.wide_texels = 0;
  return plan;
}

std::vector<FetchTrial> try_fetches(BrdfRef source, const TrainingSet& set, const CostLimit& limit,
                                    const RefineOptions& options) {
  std::vector<Candidate> candidates = candidates_by_fetches(source, limit);
  const Heat heat = volume_heat(mean_of_channels(set), options);
  const RefineOptions of_lobes = in_few_steps(options, kLobesTrialSteps);
  heat.play(candidates, [&](Candidate& candidate) {
    if (candidate.plan)
      candidate.fit =
          fit_plan(heat.parts.fitted, *candidate.plan, limit.bytes, limit.texel_bytes, of_lobes).model;
    else
      fit_volume(heat, candidate);
  });
  std::vector<FetchTrial> trials;
  for (const Candidate& candidate : candidates) trials.push_back(fetch_trial_of(candidate, heat.shares));
  return trials;
}

TrainingOptions training_for_volumes(const CostLimit& limit) {
  const std::size_t texels = limit.bytes / limit.texel_bytes,
                    times = std::clamp<std::size_t>(texels / 8192, 1, 4);
  return {.pictures = times * 40'000, .directions = times * 50'000, .crowded = true};
}

LobesFit fit_volumes(const TrainingSet& set, const std::vector<ModelSpec>& specs,
                     const RefineOptions& options) {
  const Candidate chosen = best_volume(specs, set, options);
  const ModelSpec& spec = chosen.spec;
  const bool tried = !chosen.fit.log_values.empty();

  // The first steps use few nodes and pairs, and start from the trial's fit.
  const TrainingSet coarse = about(set, kFewVolumePairs);
  const bool many = coupled_unknowns(spec, 1) > kCoarseNodes;
  const ModelSpec start = many ? at_fewer_nodes(spec, kCoarseShare) : spec;
  LobesFit fit{
      .model = tried ? resampled(chosen.fit, start) : fit_one_lobe(start, coarse, coarse.values, kStart),
      .summary = {}};
  const auto refine_part = [&](const TrainingSet& part, TableFormat format, int steps, double from,
                               double to) {
    RefineOptions these = options;
    these.format = format;
    these.max_iterations = std::min(steps, options.max_iterations);
    these.progress = part_of_progress(options.progress, from, to);
    const FitSummary done = refine(fit.model, part, these);
    const int before = fit.summary.iterations;
    fit.summary = done;
    fit.summary.iterations += before;
  };
  refine_part(coarse, TableFormat::single, tried ? kCoarseStepsAfterTrial : kCoarseSteps, kVolumeTrialTime,
              kCoarseTime);

  // The last steps use all nodes and pairs. Values that share an exponent are kept in its range only at the end, when
  // they have settled.
  if (many) fit.model = resampled(fit.model, spec);
  refine_part(set, TableFormat::single, many ? kManyFullSteps : kFullSteps, kCoarseTime, kFullTime);
  refine_part(set, options.format, many ? kManyHeldSteps : kHeldSteps, kFullTime, 1);
  return fit;
}

}  // namespace burnish
