// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/choosing/hemisphere_plan.h>
#include <burnish/fitting/choosing/lay_out.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/fitting/numerics/node_numbers.h>

namespace burnish {

namespace {

/// The forms that are tried.
constexpr ProductForm kForms[] = {
    {"q(h)"},
    {"q(h) + c(theta_d)"},
    {.model = "q(h) v(theta_h,theta_d,phi_d)", .difference = 0.3},
    {.model = "q(h) v(theta_h,theta_d,phi_s)", .difference = 0.3},
    {.model = "q(h) v(theta_h,theta_d,phi_d) + c(theta_d)", .difference = 0.2},
    {.model = "p(wo) p(wi) q(h) v(theta_h,theta_d,phi_d)", .border = 0.065, .difference = 0.065},
    {.model = "p(wo) p(wi) q(h) v(theta_h,theta_d,phi_s)", .border = 0.065, .difference = 0.1},
    {.model = "q(h) d(theta_d,phi_s) + u(h) e(theta_d,phi_s)", .difference = 0.1},
    {.model = "q(h) v(theta_h,theta_d,phi_s) + u(h) w(theta_h,theta_d,phi_s)", .difference = 0.2},
    {.model = "p(wo) p(wi) q(h) v(theta_h,theta_d,phi_d) + c(theta_d)", .border = 0.065, .difference = 0.065},
    {.model = "p(wo) p(wi) q(h) d(theta_d,phi_s) + u(h) e(theta_d,phi_s)",
     .border = 0.05,
     .difference = 0.07},
    {.model = "p(wo) p(wi) q(h) v(theta_h,theta_d,phi_s) + u(h) w(theta_h,theta_d,phi_s)",
     .border = 0.05,
     .difference = 0.2},
    {.model = "q(h) v(theta_h,theta_d,phi_s) + u(h) w(theta_h,theta_d,phi_s) + s(wo) s(wi)",
     .border = 0.05,
     .difference = 0.2},
};

// The first heat uses about this many nodes, this many pairs a node, few steps, and a part of the pairs.
constexpr double kTrialUnknowns = 900, kPairsOfNode = 6;
constexpr std::size_t kFewerFetches = 2;  // candidates are at most this far below the limit
constexpr int kFirstSteps = 20;
constexpr std::size_t kFirstPart = 8, kFinalists = 3, kFinalPart = 4;
// Above 50 dB errors of pictures are not visible; relative errors are. A fetch has to lower the errors by 3 %.
constexpr ErrorTerms kFinalShares{.pictures = 1, .relative = 2, .log_cos = 2};
constexpr double kWorthOfFetch = 0.03;
constexpr double kFirstTime = 0.15, kFinalTime = 0.4;  // progress at which they end
// The final runs at all nodes on part of the pairs, and then for the winner on all pairs.
constexpr int kFinalSteps = 8, kLastSteps = 6;

/// Resamples the fit to all nodes of the spec, and refines it by some more steps.
FitSummary refine_at_all(LogModel& fit, const ModelSpec& spec, const TrainingSet& set, RefineOptions options,
                         int steps) {
  fit = resampled(fit, spec);
  options.max_iterations = std::min(steps, options.max_iterations);
  return refine(fit, set, options);
}

/// Runs the first heat and returns the finalists. Few steps at few nodes approach the least error soonest.
std::vector<Candidate> first_heat(std::vector<ModelSpec> specs, const TrainingSet& mean,
                                  const RefineOptions& options) {
  const Heat heat{.parts = TrialParts(mean, kFirstPart),
                  .options = in_few_steps(options, kFirstSteps),
                  .shares = options.shares,
                  .worth_of_fetch = kWorthOfFetch};
  const double most = std::min(kTrialUnknowns, static_cast<double>(heat.parts.fitted.size()) / kPairsOfNode);
  std::vector<Candidate> candidates;
  for (ModelSpec& spec : specs) candidates.push_back({.spec = std::move(spec)});
  const auto fit = [&](Candidate& candidate) {
    // Steps with so few unknowns are solved directly, and the pairs determine them.
    const double nodes = static_cast<double>(coupled_unknowns(candidate.spec, 1));
    const ModelSpec trial = at_fewer_nodes(candidate.spec, std::min(1.0, most / nodes));
    candidate.fit = fit_lobes(heat.parts.fitted, trial, heat.options).model;
  };
  heat.play(candidates, fit, part_of_progress(options.progress, 0, kFirstTime));
  return finalists(std::move(candidates), kFinalists);
}

/// Returns the final heat. Finalists come near their least error at all nodes, on a quarter of the pairs. With few
/// steps some models would lose that win in the end.
Heat final_heat(const TrainingSet& mean, const RefineOptions& options, double worth_of_fetch) {
  return {.parts = TrialParts(mean, kFinalPart),
          .options = in_few_steps(options, std::min(kFinalSteps, options.max_iterations)),
          .shares = options.shares.pictures > 0 ? kFinalShares : options.shares,
          .worth_of_fetch = worth_of_fetch};
}

/// Continues a finalist from its present fit.
void refine_finalist(const Heat& finals, Candidate& candidate) {
  refine_at_all(candidate.fit, candidate.spec, finals.parts.fitted, finals.options, kFinalSteps);
}

/// Turns the mean's model into one of every channel of the set. Each channel is scaled to reflect as much of the
/// drawn pairs as its data.
LogModel in_colour(const LogModel& grey, const TrainingSet& set) {
  LogModel model{.spec = grey.spec, .channels = set.channels, .log_values = {}};
  std::vector<double> sums(set.channels);
  for (std::size_t i = 0; i < set.values.size(); ++i)
    sums[i % set.channels] += static_cast<double>(set.weights[i / set.channels]) * set.values[i];
  const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / static_cast<double>(sums.size());
  for (const std::vector<double>& logs : grey.log_values) {
    auto& all = model.log_values.emplace_back();
    for (const double v : logs) all.insert(all.end(), set.channels, v);
  }
  if (!(mean > 0)) return model;
  for (const std::vector<FactorUse>& lobe : grey.spec.lobes) {
    const auto once = std::ranges::find_if(lobe, [&](const FactorUse& use) {
      return std::ranges::count(lobe, use.table, &FactorUse::table) == 1;
    });
    if (once == lobe.end()) continue;
    std::vector<double>& logs = model.log_values[once->table];
    for (std::size_t i = 0; i < logs.size(); ++i)
      logs[i] += std::log(std::max(sums[i % set.channels], 1e-6 * mean) / mean);
  }
  return model;
}

/// Returns all forms within the limit; none if its bytes hold no form.
std::vector<ModelSpec> specs_within(const CostLimit& limit, std::size_t channels) {
  std::vector<ModelSpec> specs;
  for (const ProductForm& form : kForms)
    if (std::optional<ModelSpec> spec = lay_out(form, limit, channels);
        spec && fetch_count(*spec) <= static_cast<std::size_t>(limit.fetches))
      specs.push_back(std::move(*spec));
  return specs;
}

}  // namespace

std::vector<ModelSpec> hemisphere_specs(const CostLimit& limit, std::size_t channels) {
  std::vector<ModelSpec> specs = specs_within(limit, channels);
  if (specs.empty()) throw Error("fit: expected a budget that holds hemispheres");
  std::size_t most = 0;
  for (const ModelSpec& spec : specs) most = std::max(most, fetch_count(spec));
  std::erase_if(specs, [&](const ModelSpec& spec) { return fetch_count(spec) + kFewerFetches < most; });
  return specs;
}

LobesFit fit_hemispheres(const TrainingSet& set, const std::vector<ModelSpec>& specs,
                         const RefineOptions& options) {
  const TrainingSet mean = mean_of_channels(set);
  std::vector<Candidate> candidates = first_heat(specs, mean, options);
  const Heat finals = final_heat(mean, options, kWorthOfFetch);
  finals.play(
      candidates, [&](Candidate& candidate) { refine_finalist(finals, candidate); },
      part_of_progress(options.progress, kFirstTime, kFinalTime));
  RefineOptions rest = options;
  rest.progress = part_of_progress(options.progress, kFinalTime, 1);
  return fit_hemispheres(set, winner(candidates), rest);
}

LobesFit fit_hemispheres(const TrainingSet& set, const Candidate& start, const RefineOptions& options) {
  LobesFit fit{.model = in_colour(start.fit, set), .summary = {}};
  fit.summary = refine_at_all(fit.model, start.spec, set, options, kLastSteps);
  return fit;
}

FetchTrials try_hemispheres(const TrainingSet& set, CostLimit limit, const RefineOptions& options,
                            const LobePlan& lobes, const RefineOptions& of_lobes) {
  limit.fetches = std::numeric_limits<int>::max();
  std::vector<ModelSpec> specs = specs_within(limit, set.channels);
  if (specs.empty()) return {};

  // The candidates are the finalists and, last, the lobes. Fetches cost nothing in this heat: the knee decides.
  const TrainingSet mean = mean_of_channels(set);
  std::vector<Candidate> candidates = first_heat(std::move(specs), mean, options);
  candidates.push_back(
      {.spec = plan_to_spec(lobes, limit.bytes, set.channels, limit.texel_bytes), .plan = lobes});
  const Heat finals = final_heat(mean, options, 0);
  RefineOptions quiet = of_lobes;
  quiet.progress = nullptr;
  const auto fit = [&](Candidate& candidate) {
    if (candidate.plan)
      candidate.fit =
          fit_plan(finals.parts.fitted, *candidate.plan, limit.bytes, limit.texel_bytes, quiet).model;
    else
      refine_finalist(finals, candidate);
  };
  finals.play(candidates, fit, part_of_progress(options.progress, kFirstTime, 1));
  return best_of_each_fetch_count(std::move(candidates), finals.shares);
}

TrainingOptions training_for_hemispheres() {
  return {.pictures = 80'000, .directions = 200'000};
}

}  // namespace burnish
