// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <burnish/error.h>
#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/math/vec3.h>

namespace burnish {

namespace {

// Successive lobes are split off at these values of tan(theta_d / 2).
constexpr double kCentres[] = {0.25, 0.6, 0.4, 0.8, 0.15, 0.5, 0.7, 0.3};
constexpr std::size_t kFirstCentres[] = {0, 1, 2, 4};  // for the first, second, ... start
static_assert(std::size(kFirstCentres) == kLobeStarts);

// The log-linear start is smooth. Functions of the four angles can nearly cancel in many ways. A fit that uses these
// ways is ruined once its tables are rounded to their formats.
constexpr double kStartSmooth = 1e-3;

// Before the last refinement, fits use about this many pairs and few steps.
constexpr std::size_t kCoarsePairs = 20'000;
constexpr int kRoughSteps = 12;
constexpr int kGridSteps = 16;
// All lobes are refined in rounds: in each round the floors of shared exponents are set anew.
constexpr int kRounds = 2;
constexpr double kThinPart = 0.3;  // share of the work done by then

/// Refines a fit once more; its progress runs from `from` to `to`.
void refine_part(LobesFit& fit, const TrainingSet& set, const Lookups& lookups, RefineOptions options,
                 int steps, double from, double to) {
  options.max_iterations = std::min(steps, options.max_iterations);
  options.progress = part_of_progress(options.progress, from, to);
  FitSummary done = refine(fit.model, set, lookups, options);
  done.iterations += fit.summary.iterations;
  fit.summary = done;
}

void refine_in_rounds(LobesFit& fit, const TrainingSet& set, const RefineOptions& options, int steps,
                      double from, double to) {
  const auto part = [&](int round) { return from + (to - from) * round / kRounds; };
  const Lookups lookups = lookups_of(fit.model.spec, set);
  for (int k = 0; k < kRounds; ++k)
    refine_part(fit, set, lookups, options, (steps + k) / kRounds, part(k), part(k + 1));
}

/// Returns the number of steps of the last refinement on part of the data, before those on all data.
int rough_steps(const TrainingSet& coarse, const TrainingSet& set, const RefineOptions& options) {
  return coarse.size() < set.size() ? std::min(2 * kRoughSteps, options.max_iterations) : 0;
}

/// Runs the last refinement: on part of the data, then on all data.
void refine_fully(LobesFit& fit, const TrainingSet& coarse, const TrainingSet& set,
                  const RefineOptions& options, double from) {
  const double middle = from + 0.3 * (1 - from);
  const int rough = rough_steps(coarse, set, options);
  if (rough > 0) refine_in_rounds(fit, coarse, options, rough, from, middle);
  refine_in_rounds(fit, set, options, options.max_iterations - rough, middle, 1);
}

TrainingSet coarse_part(const TrainingSet& set) {
  return thinned(set, std::max<std::size_t>(1, set.size() / kCoarsePairs));
}

// Returns the spec without its grids; the other tables keep their order.
ModelSpec without_grids(const ModelSpec& spec) {
  ModelSpec thin;
  std::vector<std::optional<std::size_t>> place(spec.tables.size());
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    if (spec.tables[t].layout.shape == TableShape::grid) continue;
    place[t] = thin.tables.size();
    thin.tables.push_back(spec.tables[t]);
  }
  for (const std::vector<FactorUse>& lobe : spec.lobes) {
    std::vector<FactorUse>& uses = thin.lobes.emplace_back();
    for (FactorUse use : lobe) {
      const std::optional<std::size_t> kept = place[use.table];
      if (!kept) continue;
      use.table = *kept;
      uses.push_back(use);
    }
  }
  return thin;
}

double soft_step(double t, double centre) {
  return 1 / (1 + std::exp((centre - t) / 0.1));
}

bool has_disk(const ModelSpec& spec, const std::vector<FactorUse>& lobe) {
  return std::ranges::any_of(
      lobe, [&](const FactorUse& use) { return spec.tables[use.table].layout.shape == TableShape::disk; });
}

/// One lobe of a spec with its tables, and the places of these tables in the spec.
struct LobeAlone {
  ModelSpec spec;
  std::vector<std::size_t> tables;
};

LobeAlone lobe_alone(const ModelSpec& spec, std::size_t lobe) {
  LobeAlone alone{.spec = {.tables = {}, .lobes = {spec.lobes[lobe]}}, .tables = {}};
  for (FactorUse& use : alone.spec.lobes.front()) {
    const std::size_t t = use.table;
    auto known = std::ranges::find(alone.tables, t);
    if (known == alone.tables.end()) {
      alone.spec.tables.push_back(spec.tables[t]);
      known = alone.tables.insert(alone.tables.end(), t);
    }
    use.table = static_cast<std::size_t>(known - alone.tables.begin());
  }
  return alone;
}

/// A plan's spec, in which the tables that all lobes share come first, then each lobe's own.
class LobesInTurn {
 public:
  LobesInTurn(const LobePlan& plan, ModelSpec spec) : spec_(std::move(spec)) {
    for (const PlannedFactor& factor : plan.factors)
      if (factor.every_lobe) common_.push_back(factor.name);
    first_own_ = static_cast<std::size_t>(std::ranges::count_if(spec_.tables, [&](const auto& table) {
      return std::ranges::find(common_, table.name) != common_.end();
    }));
    per_lobe_ = (spec_.tables.size() - first_own_) / count();
  }

  std::size_t count() const noexcept { return spec_.lobes.size(); }
  const std::vector<std::string>& common() const noexcept { return common_; }
  ModelSpec first(std::size_t lobes) const {
    const auto tables = static_cast<std::ptrdiff_t>(first_own_ + lobes * per_lobe_);
    return {.tables = {spec_.tables.begin(), spec_.tables.begin() + tables},
            .lobes = {spec_.lobes.begin(), spec_.lobes.begin() + static_cast<std::ptrdiff_t>(lobes)}};
  }

 private:
  ModelSpec spec_;
  std::vector<std::string> common_;
  std::size_t first_own_ = 0, per_lobe_ = 0;
};

/// Splits the last lobe, and returns a model with one lobe more.
LogModel with_next_lobe(LogModel model, const LobesInTurn& lobes, std::size_t count, std::size_t start) {
  model = with_lobe_split(
      std::move(model), count - 2,
      kCentres[(kFirstCentres[start % std::size(kFirstCentres)] + count - 2) % std::size(kCentres)], "+",
      lobes.common());
  const ModelSpec spec = lobes.first(count);
  for (std::size_t t = 0; t < spec.tables.size(); ++t) model.spec.tables[t].name = spec.tables[t].name;
  return resampled(model, spec);
}

/// Returns a low value of each channel, which represents the wide lobe.
std::vector<float> low_values(const TrainingSet& set) {
  const auto channels = set.channels;
  std::vector<float> low(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<float> values;
    for (std::size_t i = 0; i < set.size(); ++i) values.push_back(set.values[i * channels + c]);
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 5);
    std::nth_element(values.begin(), place, values.end());
    low[c] = *place;
  }
  return low;
}

/// The part of the values that a lobe starts from. It is part number `place` of `count` parts along theta_d. Wide
/// lobes use what lies below the low values, other lobes what lies above them. Without low values they use
/// everything.
struct StartPart {
  std::size_t place, count;
  bool wide;
};

std::vector<float> values_of(const StartPart& part, const TrainingSet& set, const std::vector<float>& low) {
  const auto channels = set.channels;
  std::vector<float> values(set.values.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double t = project_tan_half(kProjectDifference, set.pairs[i].wi, set.pairs[i].wo);
    const auto cut = [&](std::size_t k) {
      return k == 0            ? 1.0
             : k == part.count ? 0.0
                               : soft_step(t, static_cast<double>(k) / static_cast<double>(part.count));
    };
    const double share = cut(part.place) - cut(part.place + 1);
    for (std::size_t c = 0; c < channels; ++c) {
      const double f = set.values[i * channels + c];
      const double base = low.empty() ? 0 : std::min<double>(0.9 * f, low[c]);
      values[i * channels + c] = static_cast<float>(share * (part.wide ? base : f - base));
    }
  }
  return values;
}

/// The share of the work done after `lobes` of `count` lobes. The work of each step grows with the square of its
/// number of lobes.
double lobes_done(std::size_t count, std::size_t lobes) {
  return 0.4 * static_cast<double>(lobes * lobes * lobes) / static_cast<double>(count * count * count);
}

/// Turns a model of one lobe into one of all lobes, on part of the data. Each new lobe but the last is refined
/// roughly.
void split_off(LobesFit& fit, const LobesInTurn& lobes, const TrainingSet& coarse, std::size_t start,
               RefineOptions options) {
  options.format = TableFormat::single;  // separate lobes are not yet held within their format
  for (std::size_t j = 1; j < lobes.count(); ++j) {
    refine_part(fit, coarse, lookups_of(fit.model.spec, coarse), options, kRoughSteps,
                lobes_done(lobes.count(), j - 1), lobes_done(lobes.count(), j));
    fit.model = with_next_lobe(std::move(fit.model), lobes, j + 1, start);
  }
}

/// Runs all starts from one model of one lobe on part of the data, and refines the best on all data.
LobesFit best_start(const LobesFit& first, const LobesInTurn& lobes, const TrainingSet& coarse,
                    const TrainingSet& set, const RefineOptions& options, std::size_t starts) {
  constexpr double kTried = 0.6;  // share of the work done by then
  const int rough = rough_steps(coarse, set, options);
  std::vector<LobesFit> fits(starts, first);
  std::vector<double> found(starts);
  for (std::size_t k = 0; k < starts; ++k) {
    RefineOptions trial = options;
    const double share = kTried / static_cast<double>(starts);
    if (options.progress)
      trial.progress = [&, k](double f) { options.progress(share * (static_cast<double>(k) + f)); };
    split_off(fits[k], lobes, coarse, k, trial);
    refine_in_rounds(fits[k], coarse, trial, rough, lobes_done(lobes.count(), lobes.count() - 1), 1);
    found[k] = objective(fits[k].model, coarse, options.shares);
  }
  const auto best = static_cast<std::size_t>(std::ranges::min_element(found) - found.begin());
  LobesFit fit = std::move(fits[best]);
  refine_in_rounds(fit, set, options, options.max_iterations - rough, kTried, 1);
  return fit;
}

}  // namespace

LobesFit fit_plan(const TrainingSet& set, const LobePlan& plan, std::size_t bytes, std::size_t texel_bytes,
                  const RefineOptions& options, std::size_t starts) {
  const ModelSpec whole = plan_to_spec(plan, bytes, set.channels, texel_bytes);
  if (!plan.wide.empty()) return fit_lobes(set, whole, options);

  // With many unknowns, 1-D tables are fitted first: their steps are solved directly. Grids that start as 1 can then
  // only lower the error.
  const bool direct = coupled_unknowns(whole, set.channels) <= kMaxCholeskyUnknowns;
  const LobesInTurn lobes(plan, direct ? whole : without_grids(whole));
  const bool grids = lobes.first(lobes.count()).tables.size() < whole.tables.size();
  const TrainingSet coarse = coarse_part(set);
  LobesFit fit{.model = fit_one_lobe(lobes.first(1), coarse, coarse.values,
                                     {.smooth = std::max(kStartSmooth, options.smooth)})};

  if (grids) {
    RefineOptions thin_options = options;
    if (options.progress) thin_options.progress = [&](double f) { options.progress(kThinPart * f); };
    split_off(fit, lobes, coarse, 0, thin_options);
    refine_part(fit, coarse, lookups_of(fit.model.spec, coarse), thin_options, kRoughSteps,
                lobes_done(lobes.count(), lobes.count() - 1), 1);
    fit.model = resampled(fit.model, whole);
    refine_in_rounds(fit, set, options, kGridSteps, kThinPart, 1);
    return fit;
  }

  if (lobes.count() == 1) starts = 1;  // there is nothing to split
  if (starts > 1) return best_start(fit, lobes, coarse, set, options, starts);
  split_off(fit, lobes, coarse, 0, options);
  refine_fully(fit, coarse, set, options, lobes_done(lobes.count(), lobes.count() - 1));
  return fit;
}

LobesFit fit_lobes(const TrainingSet& set, const ModelSpec& spec, const RefineOptions& options) {
  const std::size_t lobes = spec.lobes.size();
  if (lobes == 0) throw Error("fit: expected at least one lobe");
  LobesFit fit{.model = {.spec = spec, .channels = set.channels, .log_values = {}}};
  fit.model.log_values.resize(spec.tables.size());

  // If some lobes have a disk, the lobes without one are wide lobes.
  const bool any_disk = std::ranges::any_of(spec.lobes, [&](const auto& l) { return has_disk(spec, l); });
  const auto is_wide = [&](const auto& lobe) { return any_disk && !has_disk(spec, lobe); };
  const auto wide = static_cast<std::size_t>(std::ranges::count_if(spec.lobes, is_wide));
  const std::vector<float> low = wide > 0 ? low_values(set) : std::vector<float>();

  // Each lobe starts as the fit to its part of the data.
  std::size_t wide_seen = 0, narrow_seen = 0;
  for (std::size_t j = 0; j < lobes; ++j) {
    const bool of_wide = is_wide(spec.lobes[j]);
    const StartPart part{.place = of_wide ? wide_seen++ : narrow_seen++,
                         .count = of_wide ? wide : lobes - wide,
                         .wide = of_wide};
    const LobeAlone alone = lobe_alone(spec, j);
    const LogModel start = fit_one_lobe(alone.spec, set, values_of(part, set, low),
                                        {.smooth = std::max(kStartSmooth, options.smooth)});
    for (std::size_t k = 0; k < alone.tables.size(); ++k)
      fit.model.log_values[alone.tables[k]] = start.log_values[k];
  }
  refine_fully(fit, coarse_part(set), set, options, 0.1);
  return fit;
}

}  // namespace burnish
