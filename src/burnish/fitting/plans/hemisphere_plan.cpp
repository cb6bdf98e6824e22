#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/plans/hemisphere_plan.h>
#include <burnish/fitting/plans/spec_layout.h>
#include <burnish/fitting/plans/trial_sets.h>

namespace burnish {

namespace {

/// A model whose tables have no sizes yet, and its tables' shares of the texels; q and u take what is left.
struct Form {
  const char* model;
  double border = 0;      ///< of p(wo) p(wi) or s(wo) s(wi)
  double difference = 0;  ///< of all tables of the difference together
};
constexpr Form kForms[] = {
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

// Nodes of volumes by whether they tell mirror images apart, of grids along theta_d and phi_s relative to each other.
constexpr VolumeForm kFolded{14, 12, 6}, kSigned{8, 10, 10};
constexpr double kSidesOfDifference = 1.5;
constexpr int kWideNodes = 12, kMinDiskSide = 5;

// Trials: about so many pairs a node, in so few steps.
constexpr std::size_t kPairsOfNode = 6;
constexpr std::size_t kFewerFetches = 2;  // of what is tried, at most below the limit
constexpr int kTrialSteps = 20;
constexpr std::size_t kFinalists = 3, kFinalPart = 4;
// Above 50 dB what is left of pictures is not seen; relative errors are. A fetch has to lower the errors by 3 %.
constexpr ErrorTerms kFinalShares{.pictures = 1, .relative = 2, .log_cos = 2};
constexpr double kWorthOfFetch = 0.03;
constexpr double kTrialTime = 0.15, kFinalTime = 0.4;  // when they end, of the whole
// The way to all nodes is made at about so many, in so many steps, and then in so many more.
constexpr double kCoarseUnknowns = 2000;
constexpr int kCoarseSteps = 30, kFineSteps = 12;

TableLayout disk_of(double nodes, Warp warp = {}) {
  const int side = std::max(kMinDiskSide, static_cast<int>(std::sqrt(nodes)));
  return {.shape = TableShape::disk, .width = side, .height = side, .warp = warp};
}

TableLayout grid_of_difference(double nodes) {
  const double side = std::sqrt(nodes / kSidesOfDifference);
  return {.shape = TableShape::grid,
          .width = std::max(3, static_cast<int>(side)),
          .height = std::max(3, static_cast<int>(kSidesOfDifference * side))};
}

/// A use of the table, all of which are of one kind.
const FactorUse& use_of(const ModelSpec& spec, std::size_t table) {
  for (const std::vector<FactorUse>& lobe : spec.lobes)
    for (const FactorUse& use : lobe)
      if (use.table == table) return use;
  throw Error("fit: expected a use of every table");
}

/// The form's tables laid out within the bytes; none where they are too few.
std::optional<ModelSpec> laid_out(const Form& form, const CostLimit& limit, std::size_t channels) {
  const double texels = static_cast<double>(limit.bytes / limit.texel_bytes);
  ModelSpec spec = parse_model_spec(form.model, {}, false);
  std::vector<TableLayout*> of_half_vectors;
  const auto of_difference = static_cast<double>(std::ranges::count_if(spec.tables, [](const auto& table) {
    return table.layout.shape == TableShape::grid || table.layout.shape == TableShape::volume;
  }));
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    TableLayout& layout = spec.tables[t].layout;
    const FactorUse& use = use_of(spec, t);
    const double nodes = form.difference / of_difference * texels;
    if (layout.shape == TableShape::line) {
      layout.width = kWideNodes;
    } else if (layout.shape == TableShape::grid) {
      layout = grid_of_difference(nodes);
    } else if (layout.shape == TableShape::volume) {
      spec.tables[t].circle_z = use.projection_z == kProjectSide;
      layout = volume_of(spec.tables[t].circle_z ? kSigned : kFolded, nodes);
      if (layout.width < 2) return {};
    } else if (use.projection == kProjectHalf) {
      layout = {.shape = TableShape::disk, .width = 0, .height = 0, .warp = kHalfDiskWarp};
      of_half_vectors.push_back(&layout);
    } else {
      layout = disk_of(form.border * texels);
    }
  }

  // q takes what is left
  const std::size_t taken = bytes_of(spec, limit.texel_bytes, channels);
  const double rest =
      taken < limit.bytes ? static_cast<double>((limit.bytes - taken) / limit.texel_bytes) : 0;
  for (TableLayout* layout : of_half_vectors)
    *layout = disk_of(rest / static_cast<double>(of_half_vectors.size()), kHalfDiskWarp);
  if (bytes_of(spec, limit.texel_bytes, channels) > limit.bytes) return {};
  return spec;
}

/// Fits one model: few nodes come near the least error in as many steps as all of them would take to leave the start.
LobesFit fit_one(const TrainingSet& set, const ModelSpec& spec, const RefineOptions& options) {
  const auto nodes = static_cast<double>(coupled_unknowns(spec, 1));
  if (nodes <= kCoarseUnknowns) return fit_lobes(set, spec, options);
  RefineOptions coarse = options;
  coarse.format = TableFormat::single;
  coarse.max_iterations = std::min(kCoarseSteps, options.max_iterations);
  coarse.progress = part_of_progress(options.progress, 0, 0.6);
  LobesFit fit = fit_lobes(set, at_fewer_nodes(spec, kCoarseUnknowns / nodes), coarse);
  fit.model = resampled(fit.model, spec);
  RefineOptions fine = options;
  fine.max_iterations = std::min(kFineSteps, options.max_iterations);
  fine.progress = part_of_progress(options.progress, 0.6, 1);
  const int before = fit.summary.iterations;
  fit.summary = refine(fit.model, set, fine);
  fit.summary.iterations += before;
  return fit;
}

/// Of the models those that come out best, at most so many, of trials in few steps.
std::vector<ModelSpec> finalists(const std::vector<ModelSpec>& specs, const TrainingSet& mean,
                                 const RefineOptions& options) {
  const TrialSets sets(mean);
  const RefineOptions few = in_few_steps(options, kTrialSteps);
  std::vector<std::pair<double, std::size_t>> errors(specs.size());
  for_each_trial(specs.size(), options, 0, kTrialTime, [&](std::size_t k) {
    const double nodes = static_cast<double>(kPairsOfNode * coupled_unknowns(specs[k], 1));
    const ModelSpec trial =
        at_fewer_nodes(specs[k], std::min(1.0, static_cast<double>(sets.fitted.size()) / nodes));
    errors[k] = {objective(fit_lobes(sets.fitted, trial, few).model, sets.judged, few.shares), k};
  });
  std::ranges::sort(errors);
  std::vector<ModelSpec> best;
  for (std::size_t i = 0; i < std::min(kFinalists, errors.size()); ++i)
    best.push_back(specs[errors[i].second]);
  return best;
}

/// Finalists are fitted as the winner is, to a quarter of the pairs: few steps leave some behind that end ahead.
struct Finals {
  TrainingSet fitted, judged;
  RefineOptions options;
  ErrorTerms shares;

  Finals(const TrainingSet& mean, const RefineOptions& how)
      : fitted(part_of(mean, 0, kFinalPart)),
        judged(part_of(mean, kFinalPart / 2, kFinalPart)),
        options(how),
        shares(how.shares.pictures > 0 ? kFinalShares : how.shares) {
    options.progress = nullptr;
  }
  double error_of(const LobesFit& fit) const { return objective(fit.model, judged, shares); }
  double error_of(const ModelSpec& spec) const { return error_of(fit_one(fitted, spec, options)); }
};

/// The best model, each of whose fetches has to be worth it.
ModelSpec best_of(std::vector<ModelSpec> specs, const TrainingSet& set, const RefineOptions& options) {
  if (specs.size() == 1) return specs.front();
  const TrainingSet mean = mean_of_channels(set);
  specs = finalists(specs, mean, options);
  const Finals finals(mean, options);
  std::vector<double> errors(specs.size());
  for_each_trial(specs.size(), options, kTrialTime, kFinalTime, [&](std::size_t k) {
    errors[k] = finals.error_of(specs[k]) +
                kWorthOfFetch * finals.shares.sum() * static_cast<double>(fetch_count(specs[k]));
  });
  return specs[static_cast<std::size_t>(std::ranges::min_element(errors) - errors.begin())];
}

/// All forms within the limit; none where its bytes do not hold any.
std::vector<ModelSpec> specs_within(const CostLimit& limit, std::size_t channels) {
  std::vector<ModelSpec> specs;
  for (const Form& form : kForms)
    if (std::optional<ModelSpec> spec = laid_out(form, limit, channels);
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
  const ModelSpec spec = best_of(specs, set, options);
  RefineOptions rest = options;
  if (specs.size() > 1) rest.progress = part_of_progress(options.progress, kFinalTime, 1);
  return fit_one(set, spec, rest);
}

HemisphereTrials try_hemispheres(const TrainingSet& set, CostLimit limit, const RefineOptions& options,
                                 const LobePlan& lobes, const RefineOptions& of_lobes) {
  limit.fetches = std::numeric_limits<int>::max();
  std::vector<ModelSpec> specs = specs_within(limit, set.channels);
  if (specs.empty()) return {};

  // the finalists and, last, the lobes
  const TrainingSet mean = mean_of_channels(set);
  specs = finalists(specs, mean, options);
  const Finals finals(mean, options);
  RefineOptions quiet = of_lobes;
  quiet.progress = nullptr;
  std::vector<FetchTrial> trials(specs.size() + 1);
  for_each_trial(trials.size(), options, kTrialTime, 1, [&](std::size_t k) {
    const bool is_lobes = k == specs.size();
    const ModelSpec spec =
        is_lobes ? plan_to_spec(lobes, limit.bytes, set.channels, limit.texel_bytes) : specs[k];
    const double error =
        is_lobes ? finals.error_of(fit_plan(finals.fitted, lobes, limit.bytes, limit.texel_bytes, quiet))
                 : finals.error_of(spec);
    trials[k] = {.fetches = static_cast<int>(fetch_count(spec)),
                 .lobes = is_lobes,
                 .error = std::exp(error / finals.shares.sum())};
  });

  // the best of each number of fetches
  std::vector<std::size_t> order(trials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t k) { return std::pair(trials[k].fetches, trials[k].error); });
  HemisphereTrials best;
  for (const std::size_t k : order) {
    if (!best.trials.empty() && best.trials.back().fetches == trials[k].fetches) continue;
    best.trials.push_back(trials[k]);
    best.specs.push_back(trials[k].lobes ? ModelSpec{} : specs[k]);
  }
  return best;
}

TrainingOptions training_for_hemispheres() {
  return {.pictures = 80'000, .directions = 200'000};
}

}  // namespace burnish
