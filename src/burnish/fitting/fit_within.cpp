// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/choosing/fetch_plan.h>
#include <burnish/fitting/choosing/hemisphere_plan.h>
#include <burnish/fitting/choosing/overfit.h>
#include <burnish/fitting/choosing/search.h>
#include <burnish/fitting/choosing/volume_forms.h>
#include <burnish/fitting/choosing/volume_smoothness.h>
#include <burnish/fitting/fit_several.h>
#include <burnish/fitting/fit_within.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

namespace {

// Volumes and hemispheres fit all angles equally well; their errors appear first in pictures. With p(wo) p(wi), from
// four fetches on, they can also reduce absolute errors. These errors lie near grazing, and only p is as steep there.
constexpr ErrorTerms kVolumeShares{.pictures = 3, .dimmed = 0.3, .relative = 2, .log_cos = 0.6};
constexpr int kSpareFetches = 4;
constexpr double kSpareLogCos = 0.8, kSpareAbsolute = 0.1;
constexpr std::size_t kSpareTexels = 1500;  // from here on absolute errors and the usual smoothness
constexpr double kVolumeSmooth = 1e-9;
constexpr double kFewTexelsSmooth = 1e-9;   // for several lobes; few texels are smooth by themselves
constexpr double kHemisphereSmooth = 1e-6;  // few pixels reach each of its many texels
constexpr double kFarther = 1.1;            // if nodes are farther off than predicted ones
constexpr int kMoreFetchesOfNodes = 1;      // for a grid beside the line, which colours of dark films need
constexpr int kSmoothnessFetches = 2;       // for the models that choose it

// Measurements are judged at their nodes; the share of pictures limits errors elsewhere.
constexpr ErrorTerms kNodeShares{.pictures = 0.5, .dimmed = 0.1, .relative = 1, .log_cos = 1};

SearchReport report_of(const SearchResult& found) {
  SearchReport report{.trials = found.trials.size(), .kept = {}};
  for (const SearchTrial& trial : found.trials)
    if (trial.kept) report.kept.emplace_back(trial.change, trial.objective);
  return report;
}

}  // namespace

WithinBytes::WithinBytes(const FittedSource& source, const FitOptions& options, const Budget& budget,
                         std::uint64_t bytes, const Stages& stages)
    : source_(source), options_(options), budget_(budget), bytes_(bytes), stages_(stages) {}

std::size_t WithinBytes::texel() const {
  return texel_bytes(source_.format(), source_.channels());
}

CostLimit WithinBytes::limit_of(std::size_t bytes, int fetches) const {
  return {.bytes = bytes, .texel_bytes = texel(), .fetches = fetches};
}

// ---- Capacity of the bytes

bool WithinBytes::holds(std::size_t bytes) const {
  if (budget_.fetches) return holds_model(source_.reference(), limit_of(bytes, *budget_.fetches));
  return plan_fits(default_plan(bytes, budget_.lobes.value_or(0), source_.isotropic(), texel()), bytes,
                   source_.channels(), texel());
}

void WithinBytes::check() const {
  if (holds()) return;
  std::size_t most = bytes_;
  while (!holds(most)) most *= 2;
  std::size_t least = most / 2;  // the smallest capacity is between these
  while (most - least > 1) (holds((least + most) / 2) ? most : least) = (least + most) / 2;
  throw Error(
      fmt::format("fit: expected a budget of at least {} bytes for {} channels in format {}, found {}", most,
                  source_.channels(), to_string(source_.format()), bytes_));
}

// ---- Several lobes

/// Returns the smoothness of lobes: the given one, or one that suits the plan.
double WithinBytes::smooth_of(const LobePlan& plan) const {
  const bool few = plan.lobes > 1 && plan.wide.empty() && bytes_ < kSpareTexels * texel();
  return options_.smooth.value_or(few ? kFewTexelsSmooth : RefineOptions().smooth);
}

WithinBytes::ChosenLobes WithinBytes::choose_lobes() const {
  ChosenLobes lobes{.drawn = training_for(bytes_, texel(), source_.isotropic()),
                    .set = {},
                    .refine = refine_options(source_, options_, budget_.loss, stages_),
                    .plan = {}};
  lobes.drawn.seed = options_.seed;
  lobes.set = source_.drawn_set(lobes.drawn, stages_);
  if (source_.judged_at_nodes() && budget_.loss == FitLoss::image) lobes.refine.shares = kNodeShares;
  RefineOptions trials = lobes.refine;
  trials.progress = stages_.of("choosing lobes");
  lobes.plan = plan_for(source_.reference(), lobes.set, bytes_, budget_.lobes.value_or(0), texel(), trials);
  lobes.refine.smooth = smooth_of(lobes.plan);
  return lobes;
}

/// Replaces the plan by the result of a search.
SearchReport WithinBytes::search(ChosenLobes& lobes) const {
  const SearchResult found = search_plan(lobes.set, lobes.plan,
                                         {.bytes = static_cast<std::size_t>(bytes_),
                                          .texel_bytes = texel(),
                                          .refine = lobes.refine,
                                          .progress = stages_.of("searching")});
  lobes.plan = found.plan;
  return report_of(found);
}

FittedLobes WithinBytes::fit_lobes(ChosenLobes lobes) const {
  LobesReport report{.loss = budget_.loss, .budget = bytes_};
  if (budget_.search) report.search = search(lobes);

  // The smoothness of tables is the given one, or the one that avoids overfitting.
  const auto& [drawn, set, refine, plan] = lobes;
  if (options_.smooth)
    return finish(source_, fit_plan(set, plan, bytes_, texel(), refine, kLobeStarts), set, refine,
                  std::move(report), stages_);
  const auto [fit, smooth] =
      fit_without_overfit(source_.reference(), set, plan, bytes_, texel(), drawn, refine);
  report.smooth = lobes.refine.smooth = smooth;
  return finish(source_, fit, set, refine, std::move(report), stages_);
}

// ---- Within a number of fetches

FittedLobes WithinBytes::fit_with(int fetches) const {
  const CostLimit limit = limit_of(bytes_, fetches);
  if (takes_lobes(source_.reference(), limit)) return fit_lobes_within(limit);
  if (source_.isotropic()) return fit_volumes_within(limit);
  return fit_hemispheres_to(fetches, source_.drawn_set(training_for_hemispheres(), stages_),
                            hemisphere_specs(limit, source_.channels()));
}

FittedLobes WithinBytes::fit_lobes_within(const CostLimit& limit) const {
  RefineOptions refine = refine_options(source_, options_, budget_.loss, stages_);
  const TrainingSet set =
      source_.drawn_set(training_for(bytes_, limit.texel_bytes, source_.isotropic()), stages_);
  const LobePlan plan = plan_within(source_.reference(), limit);
  refine.smooth = smooth_of(plan);
  return finish(source_, fit_plan(set, plan, limit.bytes, limit.texel_bytes, refine, kLobeStarts), set,
                refine, {.loss = budget_.loss, .budget = bytes_, .fetches = limit.fetches}, stages_);
}

FittedLobes WithinBytes::fit_volumes_within(const CostLimit& limit) const {
  LobesReport report{.loss = budget_.loss, .budget = bytes_, .fetches = limit.fetches};
  RefineOptions refine = refine_options(source_, options_, budget_.loss, stages_);

  // The weights of the errors depend on fetches and bytes.
  if (budget_.loss == FitLoss::image) {
    refine.shares = kVolumeShares;
    if (limit.fetches >= kSpareFetches) {
      refine.shares.log_cos = kSpareLogCos;
      if (bytes_ >= kSpareTexels * limit.texel_bytes) refine.shares.absolute = kSpareAbsolute;
    }
    if (source_.judged_at_nodes()) refine.shares = kNodeShares;
  }

  // The smoothness is the given one, the usual one, or the one that predicts nodes best.
  if (!options_.smooth) {
    refine.smooth = kVolumeSmooth;
    if (budget_.scattered.cross_validate && !source_.nodes() && is_measurement(source_.source()))
      report.smooth = refine.smooth = volume_smoothness(limit);
  }
  const TrainingSet set = source_.drawn_set(training_for_volumes(limit), stages_);
  return finish(source_, fit_volumes(set, volume_specs(source_.reference(), limit), refine), set, refine,
                std::move(report), stages_);
}

/// Returns the smoothness that predicts nodes best, judged with a model of few fetches.
double WithinBytes::volume_smoothness(CostLimit limit) const {
  limit.fetches = std::min(limit.fetches, kSmoothnessFetches);
  const std::vector<ModelSpec> specs = volume_specs(source_.reference(), limit);
  return choose_volume_smoothness(measured_nodes(source_.source()), specs.front(), options_.symmetrize);
}

RefineOptions WithinBytes::options_of_hemispheres() const {
  RefineOptions refine = refine_options(source_, options_, budget_.loss, stages_);
  if (!options_.smooth) refine.smooth = kHemisphereSmooth;
  if (budget_.loss == FitLoss::image) refine.shares = kVolumeShares;
  return refine;
}

/// Fits hemispheres. `from`: the specs to choose from, or the chosen candidate. The steps on all pairs count albedos
/// too.
FittedLobes WithinBytes::fit_hemispheres_to(int fetches, TrainingSet set, const auto& from) const {
  RefineOptions refine = options_of_hemispheres();
  if (counts_albedos(source_, budget_.loss)) add_albedos(source_, set, refine);
  const LobesFit fit = fit_hemispheres(set, from, refine);
  return rounded(fit, set, refine, {.loss = budget_.loss, .budget = bytes_, .fetches = fetches});
}

FittedLobes WithinBytes::fit_nodes() const {
  const MeasuredNodes& nodes = *source_.nodes();
  FittedLobes fewer = fit_with(*budget_.fetches);
  const NodeFigures near = node_figures(nodes, fewer.brdf), &unseen = *source_.nodes_report()->held_out;
  if (near.relative <= kFarther * unseen.relative && near.log_cos <= kFarther * unseen.log_cos) return fewer;
  const int fetches = *budget_.fetches + kMoreFetchesOfNodes;
  if (!holds_model(source_.reference(), limit_of(bytes_, fetches))) return fewer;
  const WithinBytes again(source_, options_, budget_, bytes_,
                          stages_.with(fmt::format(", {} fetches", fetches)));
  FittedLobes more = again.fit_with(fetches);
  const NodeFigures nearer = node_figures(nodes, more.brdf);
  return nearer.relative * nearer.log_cos < near.relative * near.log_cos ? std::move(more) : std::move(fewer);
}

// ---- At the knee

/// Fits an isotropic source with the number of fetches at the knee of trials with few and with many fetches.
FittedLobes WithinBytes::fit_at_isotropic_knee() const {
  const CostLimit limit = limit_of(bytes_, 0);
  const TrainingSet set = source_.drawn_set(training_for_volumes(limit), stages_);
  std::vector<FetchTrial> trials =
      try_fetches(source_.reference(), set, limit, refine_options(source_, options_, budget_.loss, stages_));
  const FetchTrial* const chosen = trials.empty() ? nullptr : &trial_at_knee(trials);
  FittedLobes fitted = chosen && !chosen->lobes ? fit_with(chosen->fetches) : fit_lobes();
  fitted.report.fetch_trials = std::move(trials);
  return fitted;
}

/// Fits an anisotropic source with the number of fetches at the knee of such trials.
FittedLobes WithinBytes::fit_at_hemispheres_knee() const {
  const CostLimit limit = limit_of(bytes_, std::numeric_limits<int>::max());
  if (takes_lobes(source_.reference(), limit)) return fit_lobes();
  ChosenLobes lobes = choose_lobes();
  lobes.set = {};  // drawn again if lobes are chosen: one set in memory at a time
  TrainingSet set = source_.drawn_set(training_for_hemispheres(), stages_);
  RefineOptions trials = options_of_hemispheres();
  trials.progress = stages_.of("choosing fetches");
  FetchTrials tried = try_hemispheres(set, limit, trials, lobes.plan, lobes.refine);
  FittedLobes fitted = [&] {
    const FetchTrial* const chosen = tried.trials.empty() ? nullptr : &trial_at_knee(tried.trials);
    if (chosen && !chosen->lobes)
      return fit_hemispheres_to(0, std::move(set),
                                tried.candidates[static_cast<std::size_t>(chosen - tried.trials.data())]);
    set = {};
    lobes.set = source_.drawn_set(lobes.drawn, stages_);
    return fit_lobes(std::move(lobes));
  }();
  fitted.report.fetch_trials = std::move(tried.trials);
  return fitted;
}

}  // namespace burnish
