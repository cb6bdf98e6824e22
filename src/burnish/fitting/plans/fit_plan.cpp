#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/plans/fit_plan.h>
#include <burnish/math/vec3.h>

namespace burnish {

namespace {

// Where successive lobes are split off, in tan(theta_d / 2).
constexpr double kCentres[] = {0.25, 0.6, 0.4, 0.8, 0.15, 0.5, 0.7, 0.3};

// The log-linear start is smooth: functions of the four angles nearly add up to nothing in many ways, and a
// fit that uses them is ruined once its tables are kept within their formats.
constexpr double kStartSmooth = 1e-3;

// The way to the last refinement is made on about this many pairs and in few steps.
constexpr std::size_t kCoarsePairs = 20'000;
constexpr int kRoughSteps = 12;
constexpr int kGridSteps = 16;
// Refinements of all lobes go in rounds: each sees the floors that shared exponents set anew.
constexpr int kRounds = 2;
constexpr double kThinPart = 0.3;  // share of the work done by then

/// Adds one refinement to the summary; its progress runs from `from` to `to`.
void refine_part(LogModel& model, const TrainingSet& set, const Lookups& lookups, RefineOptions options,
                 int steps, double from, double to, FitSummary& summary) {
  options.max_iterations = std::min(steps, options.max_iterations);
  if (options.progress)
    options.progress = [whole = options.progress, from, to](double f) { whole(from + f * (to - from)); };
  const FitSummary done = refine(model, set, lookups, options);
  summary.iterations += done.iterations;
  summary.error_before = done.error_before;
  summary.error_after = done.error_after;
  summary.stop_reason = done.stop_reason;
}

void refine_in_rounds(LogModel& model, const TrainingSet& set, const RefineOptions& options, int steps,
                      double from, double to, FitSummary& summary) {
  const auto part = [&](int round) { return from + (to - from) * round / kRounds; };
  const Lookups lookups = find_lookups(model.spec, set);
  for (int k = 0; k < kRounds; ++k)
    refine_part(model, set, lookups, options, (steps + k) / kRounds, part(k), part(k + 1), summary);
}

/// The last refinement: on part of the data, then on all.
void refine_fully(LogModel& model, const TrainingSet& coarse, const TrainingSet& set,
                  const RefineOptions& options, double from, FitSummary& summary) {
  const double middle = from + 0.3 * (1 - from);
  const int rough = coarse.size() < set.size() ? std::min(2 * kRoughSteps, options.max_iterations) : 0;
  if (rough > 0) refine_in_rounds(model, coarse, options, rough, from, middle, summary);
  refine_in_rounds(model, set, options, options.max_iterations - rough, middle, 1, summary);
}

TrainingSet coarse_part(const TrainingSet& set) {
  return thinned(set, std::max<std::size_t>(1, set.size() / kCoarsePairs));
}

bool solved_directly(const ModelSpec& spec, std::size_t channels) {
  // a table that the channels share makes them one system
  const bool coupled = std::ranges::any_of(spec.tables, &ModelSpec::TableSpec::shared);
  std::size_t unknowns = 0;
  for (const ModelSpec::TableSpec& table : spec.tables)
    unknowns += table.layout.node_count() * (coupled && !table.shared ? channels : 1);
  return unknowns <= kMostDirectUnknowns;
}

// The spec without its grids, the tables in the same order.
ModelSpec without_grids(const ModelSpec& spec) {
  ModelSpec thin;
  std::vector<int> place(spec.tables.size(), -1);
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    if (spec.tables[t].layout.shape == TableShape::grid) continue;
    place[t] = static_cast<int>(thin.tables.size());
    thin.tables.push_back(spec.tables[t]);
  }
  for (const std::vector<FactorUse>& lobe : spec.lobes) {
    std::vector<FactorUse>& uses = thin.lobes.emplace_back();
    for (FactorUse use : lobe) {
      use.table = place[static_cast<std::size_t>(use.table)];
      if (use.table >= 0) uses.push_back(use);
    }
  }
  return thin;
}

double soft_step(double t, double centre) {
  return 1 / (1 + std::exp((centre - t) / 0.1));
}

bool has_disk(const ModelSpec& spec, const std::vector<FactorUse>& lobe) {
  return std::ranges::any_of(lobe, [&](const FactorUse& use) {
    return spec.tables[static_cast<std::size_t>(use.table)].layout.shape == TableShape::disk;
  });
}

// The tables of one lobe alone.
ModelSpec lobe_spec(const ModelSpec& spec, std::size_t lobe, std::vector<std::size_t>& tables) {
  ModelSpec part{.tables = {}, .lobes = {spec.lobes[lobe]}};
  for (FactorUse& use : part.lobes.front()) {
    const auto t = static_cast<std::size_t>(use.table);
    auto known = std::ranges::find(tables, t);
    if (known == tables.end()) {
      part.tables.push_back(spec.tables[t]);
      known = tables.insert(tables.end(), t);
    }
    use.table = static_cast<int>(known - tables.begin());
  }
  return part;
}

}  // namespace

LobesFit fit_plan(const TrainingSet& set, const LobePlan& plan, std::size_t bytes, std::size_t texel_bytes,
                  const RefineOptions& options) {
  const ModelSpec whole = plan_to_spec(plan, bytes, set.channels, texel_bytes);
  if (!plan.wide.empty()) return fit_lobes(set, whole, options);
  // Of many unknowns the 1-D tables first: their steps are solved directly, and grids that start as 1 only
  // lower the error.
  const ModelSpec thin =
      solved_directly(whole, static_cast<std::size_t>(set.channels)) ? whole : without_grids(whole);
  std::vector<std::string> common;
  for (const PlannedFactor& factor : plan.factors)
    if (factor.every_lobe) common.push_back(factor.name);
  const std::size_t lobes = thin.lobes.size();
  const auto first_own = static_cast<std::size_t>(std::ranges::count_if(
      thin.tables, [&](const auto& table) { return std::ranges::find(common, table.name) != common.end(); }));
  const std::size_t per_lobe = (thin.tables.size() - first_own) / lobes;
  const TrainingSet coarse = coarse_part(set);
  const auto first_lobes = [&](std::size_t count) {
    return ModelSpec{.tables = {thin.tables.begin(), thin.tables.begin() + static_cast<std::ptrdiff_t>(
                                                                               first_own + count * per_lobe)},
                     .lobes = {thin.lobes.begin(), thin.lobes.begin() + static_cast<std::ptrdiff_t>(count)}};
  };
  const bool grids = thin.tables.size() < whole.tables.size();
  RefineOptions thin_options = options;
  if (grids && options.progress) thin_options.progress = [&](double f) { options.progress(kThinPart * f); };
  // lobes that part are not yet held within their format
  RefineOptions rough_options = thin_options;
  rough_options.format = TableFormat::single;
  LobesFit fit{
      .model = fit_one_lobe(first_lobes(1), coarse, coarse.values, std::max(kStartSmooth, options.smooth))};
  // the work grows with the square of the lobes
  const auto done = [&](std::size_t j) {
    return 0.4 * static_cast<double>(j * j * j) / static_cast<double>(lobes * lobes * lobes);
  };
  for (std::size_t j = 1; j <= lobes; ++j) {
    if (j > 1) {
      fit.model =
          with_lobe_split(std::move(fit.model), j - 2, kCentres[(j - 2) % std::size(kCentres)], "+", common);
      const ModelSpec spec = first_lobes(j);
      for (std::size_t t = 0; t < spec.tables.size(); ++t)
        fit.model.spec.tables[t].name = spec.tables[t].name;
      fit.model = resampled(fit.model, spec);
    }
    if (j < lobes || grids)
      refine_part(fit.model, coarse, find_lookups(fit.model.spec, coarse),
                  j < lobes ? rough_options : thin_options, kRoughSteps, done(j - 1), done(j), fit.summary);
    else
      refine_fully(fit.model, coarse, set, thin_options, done(j - 1), fit.summary);
  }
  if (grids) {
    fit.model = resampled(fit.model, whole);
    refine_in_rounds(fit.model, set, options, kGridSteps, kThinPart, 1, fit.summary);
  }
  return fit;
}

LobesFit fit_lobes(const TrainingSet& set, const ModelSpec& spec, const RefineOptions& options) {
  const std::size_t lobes = spec.lobes.size(), channels = static_cast<std::size_t>(set.channels);
  if (lobes == 0) throw Error("fit: expected at least one lobe");
  LobesFit fit{.model = {.spec = spec, .channels = set.channels, .log_values = {}}};
  fit.model.log_values.resize(spec.tables.size());

  // A low value of each channel stands for what is spread wide.
  std::vector<float> low(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<float> values;
    for (std::size_t i = 0; i < set.size(); ++i) values.push_back(set.values[i * channels + c]);
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 5);
    std::nth_element(values.begin(), place, values.end());
    low[c] = *place;
  }
  const bool any_disk = std::ranges::any_of(spec.lobes, [&](const auto& l) { return has_disk(spec, l); });
  std::size_t wide = 0;
  for (const auto& lobe : spec.lobes) wide += any_disk && !has_disk(spec, lobe);
  const std::size_t narrow = lobes - wide;

  std::size_t wide_seen = 0, narrow_seen = 0;
  for (std::size_t j = 0; j < lobes; ++j) {
    const bool is_wide = any_disk && !has_disk(spec, spec.lobes[j]);
    const std::size_t group = is_wide ? wide : narrow, place = is_wide ? wide_seen++ : narrow_seen++;
    std::vector<float> target(set.values.size());
    for (std::size_t i = 0; i < set.size(); ++i) {
      const double t = project_tan_half(kProjectDifference, set.pairs[i].wi, set.pairs[i].wo);
      const auto cut = [&](std::size_t k) {
        return k == 0       ? 1.0
               : k == group ? 0.0
                            : soft_step(t, static_cast<double>(k) / static_cast<double>(group));
      };
      const double share = cut(place) - cut(place + 1);
      for (std::size_t c = 0; c < channels; ++c) {
        const double f = set.values[i * channels + c];
        const double base = wide > 0 ? std::min<double>(0.9 * f, low[c]) : 0;
        target[i * channels + c] = static_cast<float>(share * (is_wide ? base : f - base));
      }
    }
    std::vector<std::size_t> tables;
    const LogModel part =
        fit_one_lobe(lobe_spec(spec, j, tables), set, target, std::max(kStartSmooth, options.smooth));
    for (std::size_t k = 0; k < tables.size(); ++k) fit.model.log_values[tables[k]] = part.log_values[k];
  }
  refine_fully(fit.model, coarse_part(set), set, options, 0.1, fit.summary);
  return fit;
}

}  // namespace burnish
