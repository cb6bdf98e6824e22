#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/plans/hemisphere_plan.h>
#include <burnish/fitting/plans/spec_layout.h>
#include <burnish/fitting/plans/trial_sets.h>
#include <burnish/math/parallel.h>

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

/// Of models, each fitted to a part of the set and judged on another.
std::size_t best_of(const std::vector<ModelSpec>& specs, const TrainingSet& set,
                    const RefineOptions& options) {
  if (specs.size() == 1) return 0;
  const TrialSets sets(mean_of_channels(set));
  const RefineOptions few = in_few_steps(options, kTrialSteps);
  std::vector<double> errors(specs.size());
  for_each_chunk(specs.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    const double nodes = static_cast<double>(kPairsOfNode * coupled_unknowns(specs[k], 1));
    const ModelSpec trial =
        at_fewer_nodes(specs[k], std::min(1.0, static_cast<double>(sets.fitted.size()) / nodes));
    errors[k] = objective(fit_lobes(sets.fitted, trial, few).model, sets.judged, few.shares);
  });
  return static_cast<std::size_t>(std::ranges::min_element(errors) - errors.begin());
}

}  // namespace

std::vector<ModelSpec> hemisphere_specs(const CostLimit& limit, std::size_t channels) {
  std::vector<ModelSpec> specs;
  for (const Form& form : kForms)
    if (std::optional<ModelSpec> spec = laid_out(form, limit, channels);
        spec && fetch_count(*spec) <= static_cast<std::size_t>(limit.fetches))
      specs.push_back(std::move(*spec));
  if (specs.empty()) throw Error("fit: expected a budget that holds hemispheres");
  std::size_t most = 0;
  for (const ModelSpec& spec : specs) most = std::max(most, fetch_count(spec));
  std::erase_if(specs, [&](const ModelSpec& spec) { return fetch_count(spec) + kFewerFetches < most; });
  return specs;
}

LobesFit fit_hemispheres(const TrainingSet& set, const std::vector<ModelSpec>& specs,
                         const RefineOptions& options) {
  const ModelSpec& spec = specs[best_of(specs, set, options)];
  const auto nodes = static_cast<double>(coupled_unknowns(spec, 1));
  if (nodes <= kCoarseUnknowns) return fit_lobes(set, spec, options);

  // few nodes come near the least error in as many steps as all of them would take to leave the start
  const auto progress = [&](double from, double to) -> std::function<void(double)> {
    if (!options.progress) return nullptr;
    return [&options, from, to](double f) { options.progress(from + f * (to - from)); };
  };
  RefineOptions coarse = options;
  coarse.format = TableFormat::single;
  coarse.max_iterations = std::min(kCoarseSteps, options.max_iterations);
  coarse.progress = progress(0, 0.6);
  LobesFit fit = fit_lobes(set, at_fewer_nodes(spec, kCoarseUnknowns / nodes), coarse);
  fit.model = resampled(fit.model, spec);
  RefineOptions fine = options;
  fine.max_iterations = std::min(kFineSteps, options.max_iterations);
  fine.progress = progress(0.6, 1);
  const int before = fit.summary.iterations;
  fit.summary = refine(fit.model, set, fine);
  fit.summary.iterations += before;
  return fit;
}

TrainingOptions training_for_hemispheres() {
  return {.pictures = 80'000, .directions = 200'000};
}

}  // namespace burnish
