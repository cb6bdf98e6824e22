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
#include <burnish/fitting/choosing/trial_sets.h>
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

// Trials: at about so many nodes, whose steps are solved directly, of so many pairs each, in so few steps.
constexpr double kTrialUnknowns = 900, kPairsOfNode = 6;
constexpr std::size_t kFewerFetches = 2;  // of what is tried, at most below the limit
constexpr int kTrialSteps = 20;
constexpr std::size_t kFinalists = 3, kFinalPart = 4;
// Above 50 dB what is left of pictures is not seen; relative errors are. A fetch has to lower the errors by 3 %.
constexpr ErrorTerms kFinalShares{.pictures = 1, .relative = 2, .log_cos = 2};
constexpr double kWorthOfFetch = 0.03;
constexpr double kTrialTime = 0.15, kFinalTime = 0.4;  // when they end, of the whole
// Then at all nodes: on part of the pairs, and of the best one on all of them.
constexpr int kFinalSteps = 8, kLastSteps = 6;

using Candidate = HemisphereCandidate;

/// What the model's fetches have to lower the objective by.
double cost(const ModelSpec& spec, const ErrorTerms& shares) {
  return kWorthOfFetch * shares.sum() * static_cast<double>(fetch_count(spec));
}

/// The fit at all nodes of the spec, after some more steps.
FitSummary refine_at_all(LogModel& fit, const ModelSpec& spec, const TrainingSet& set, RefineOptions options,
                         int steps) {
  fit = resampled(fit, spec);
  options.max_iterations = std::min(steps, options.max_iterations);
  return refine(fit, set, options);
}

/// The models in few steps at few nodes, which come near the least error soonest; the best ones come first.
std::vector<Candidate> tried(const std::vector<ModelSpec>& specs, const TrainingSet& mean,
                             const RefineOptions& options) {
  const TrialSets sets(mean);
  const RefineOptions few = in_few_steps(options, kTrialSteps);
  const double most = std::min(kTrialUnknowns, static_cast<double>(sets.fitted.size()) / kPairsOfNode);
  std::vector<Candidate> candidates(specs.size());
  for_each_trial(specs.size(), options, 0, kTrialTime, [&](std::size_t k) {
    const double nodes = static_cast<double>(coupled_unknowns(specs[k], 1));
    const ModelSpec trial = at_fewer_nodes(specs[k], std::min(1.0, most / nodes));
    candidates[k] = {.spec = specs[k], .fit = fit_lobes(sets.fitted, trial, few).model, .error = 0};
    candidates[k].error = objective(candidates[k].fit, sets.judged, few.shares) + cost(specs[k], few.shares);
  });
  std::ranges::stable_sort(candidates, {}, &Candidate::error);
  return candidates;
}

/// Finalists come near their least error at all nodes, of a quarter of the pairs: few steps leave some behind that
/// end ahead.
struct Finals {
  TrainingSet fitted, judged;
  RefineOptions options;
  ErrorTerms shares;

  Finals(const TrainingSet& mean, const RefineOptions& how)
      : fitted(part_of(mean, 0, kFinalPart)),
        judged(part_of(mean, kFinalPart / 2, kFinalPart)),
        options(how),
        shares(how.shares.pictures > 0 ? kFinalShares : how.shares) {
    options.format = TableFormat::single;
    options.progress = nullptr;
  }
  double error_of(const LogModel& fit) const { return objective(fit, judged, shares); }
  void play(Candidate& candidate) const {
    refine_at_all(candidate.fit, candidate.spec, fitted, options, kFinalSteps);
    candidate.error = error_of(candidate.fit);
  }
};

/// The mean's model for every channel of the set, each of which reflects as much of what is drawn as it does.
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

/// All forms within the limit; none where its bytes do not hold any.
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
  std::vector<Candidate> candidates = tried(specs, mean, options);
  candidates.resize(std::min(kFinalists, candidates.size()));

  // each fetch has to be worth it
  const Finals finals(mean, options);
  for_each_trial(candidates.size(), options, kTrialTime, kFinalTime, [&](std::size_t k) {
    finals.play(candidates[k]);
    candidates[k].error += cost(candidates[k].spec, finals.shares);
  });
  RefineOptions rest = options;
  rest.progress = part_of_progress(options.progress, kFinalTime, 1);
  return fit_hemispheres(set, *std::ranges::min_element(candidates, {}, &Candidate::error), rest);
}

LobesFit fit_hemispheres(const TrainingSet& set, const HemisphereCandidate& start,
                         const RefineOptions& options) {
  LobesFit fit{.model = in_colour(start.fit, set), .summary = {}};
  fit.summary = refine_at_all(fit.model, start.spec, set, options, kLastSteps);
  return fit;
}

HemisphereTrials try_hemispheres(const TrainingSet& set, CostLimit limit, const RefineOptions& options,
                                 const LobePlan& lobes, const RefineOptions& of_lobes) {
  limit.fetches = std::numeric_limits<int>::max();
  const std::vector<ModelSpec> specs = specs_within(limit, set.channels);
  if (specs.empty()) return {};

  // the finalists and, last, the lobes
  const TrainingSet mean = mean_of_channels(set);
  std::vector<Candidate> candidates = tried(specs, mean, options);
  candidates.resize(std::min(kFinalists, candidates.size()));
  candidates.push_back(
      {.spec = plan_to_spec(lobes, limit.bytes, set.channels, limit.texel_bytes), .fit = {}, .error = 0});
  const Finals finals(mean, options);
  RefineOptions quiet = of_lobes;
  quiet.progress = nullptr;
  std::vector<FetchTrial> trials(candidates.size());
  for_each_trial(candidates.size(), options, kTrialTime, 1, [&](std::size_t k) {
    Candidate& candidate = candidates[k];
    const bool is_lobes = k + 1 == candidates.size();
    if (is_lobes)
      candidate.error =
          finals.error_of(fit_plan(finals.fitted, lobes, limit.bytes, limit.texel_bytes, quiet).model);
    else
      finals.play(candidate);
    trials[k] = {.fetches = static_cast<int>(fetch_count(candidate.spec)),
                 .lobes = is_lobes,
                 .error = std::exp(candidate.error / finals.shares.sum())};
  });

  // the best of each number of fetches
  std::vector<std::size_t> order(trials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t k) { return std::pair(trials[k].fetches, trials[k].error); });
  HemisphereTrials best;
  for (const std::size_t k : order) {
    if (!best.trials.empty() && best.trials.back().fetches == trials[k].fetches) continue;
    best.trials.push_back(trials[k]);
    best.candidates.push_back(std::move(candidates[k]));
  }
  return best;
}

TrainingOptions training_for_hemispheres() {
  return {.pictures = 80'000, .directions = 200'000};
}

}  // namespace burnish
