#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/baselines/negative_lobes.h>
#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/fitting/choosing/between_incidences.h>
#include <burnish/fitting/choosing/budget_ladder.h>
#include <burnish/fitting/choosing/fetch_plan.h>
#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/choosing/frontal_pixels.h>
#include <burnish/fitting/choosing/hemisphere_plan.h>
#include <burnish/fitting/choosing/order_tables.h>
#include <burnish/fitting/choosing/overfit.h>
#include <burnish/fitting/choosing/scattered_plan.h>
#include <burnish/fitting/choosing/search.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/fitting/choosing/volume_forms.h>
#include <burnish/fitting/choosing/volume_smoothness.h>
#include <burnish/fitting/energy.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/one_lobe/cross_validation.h>
#include <burnish/fitting/one_lobe/log_error.h>
#include <burnish/fitting/refinement/rounding.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/reflectance/outliers.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

namespace {

// Scattered samples are few and noisy: they are fitted robustly, with the smoothness that predicts best.
constexpr int kScatteredReweightings = 4;
// Of samples that weigh differently, whose conjugate gradients take longer.
constexpr double kBackscatterTolerance = 2e-4;
constexpr double kExpectedWeight = 0.01;  // of a sample of between_incidences
constexpr std::size_t kExpectedFolds = 5;
// Steps that look at albedos, and their share in the loss.
constexpr int kAlbedoSteps = 20, kLongAlbedoSteps = 6;
constexpr double kAlbedoShare = 0.3;

// Pairs drawn for one lobe from a source that is a function; an anisotropic one has one dimension more.
constexpr std::size_t kIsotropicSamples = 200'000, kAnisotropicSamples = 500'000;
constexpr std::size_t kBaselineSamples = 200'000;
constexpr std::size_t kBookSamples = 1000;
// Anisotropic scattered samples: fewer make one lobe; of more a part is fitted, since time grows with them.
constexpr std::size_t kFewAnisotropic = 1000, kMostScattered = 150'000;

// Of DefaultBudget.
constexpr int kIsotropicFetches = 2, kAnisotropicFetches = 6;

// Pairs that the fit did not see, for the error that is reported.
constexpr std::size_t kHeldOutPairs = 20'000;
constexpr int kHeldOutSphereSize = 128;  // of a baseline's the defaults of FigureOptions

// Volumes and hemispheres follow all angles alike; what they lack shows in pictures first. With p(wo) p(wi) beside them, of four
// fetches, there is some to spare, for absolute errors too: these lie near grazing, and p alone is as steep there.
constexpr ErrorTerms kVolumeShares{.pictures = 3, .dimmed = 0.3, .relative = 2, .log_cos = 0.6};
constexpr int kSpareFetches = 4;
constexpr double kSpareLogCos = 0.8, kSpareAbsolute = 0.1;
constexpr std::size_t kSpareTexels = 1500;  // from here on, for absolute errors and smoothness
constexpr double kVolumeSmooth = 1e-9;
constexpr double kFewTexelsSmooth = 1e-9;   // of several lobes; few texels are smooth by themselves
constexpr double kHemisphereSmooth = 1e-6;  // whose many texels few pixels reach
constexpr double kFarther = 1.1;            // from nodes than nodes are foretold: a fetch more is tried
constexpr int kMoreFetchesOfNodes = 1;      // dark films' colours ask for a grid beside the line
constexpr int kSmoothnessFetches = 2;       // of the models by which it is chosen
constexpr double kFrontalShare = 0.1;       // of pixels, see with_frontal_pixels

// What was measured is judged where it was measured; pictures keep the rest from running away.
constexpr ErrorTerms kNodeShares{.pictures = 0.5, .dimmed = 0.1, .relative = 1, .log_cos = 1};

bool has_disk(const ModelSpec& spec) {
  return std::ranges::any_of(spec.tables,
                             [](const auto& table) { return table.layout.shape == TableShape::disk; });
}

/// Every so many of the samples, so that they are about `most`.
Samples at_most(std::size_t most, const Samples& samples) {
  const std::size_t step = (samples.size() + most - 1) / most;
  if (step <= 1) return samples;
  std::vector<std::size_t> subset;
  for (std::size_t i = 0; i < samples.size(); i += step) subset.push_back(i);
  return select(samples, subset);
}

Error no_model() {
  return Error("fit: expected a product of tables, found a baseline");
}

BrdfRef ref_of(const FactoredBrdf& brdf) noexcept {
  return brdf;
}
BrdfRef ref_of(const BaselineBrdf& brdf) noexcept {
  return baseline_ref(brdf);
}

/// One fit of one source.
class Fitter {
 public:
  Fitter(const Source& source, const FitOptions& options)
      : source_(source), options_(options), brdf_(source.ref()) {
    if (options.samples == std::size_t{0}) throw Error("fit: expected at least one sample, found 0");
    if (options.symmetrize) symmetrized_.emplace(brdf_);
    if (options.target.value_or(default_target(source, options)) == FitTarget::nodes)
      take_nodes();
    else if (options.hold_out)
      throw Error("fit: expected the nodes as the target, since some are to be held out");
  }
  Fitter(const Fitter&) = delete;

  Fit run() {
    const auto start = std::chrono::steady_clock::now();
    auto brdf =
        std::visit([&](const auto& form) { return fit(form); }, options_.form.value_or(DefaultBudget{}));
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report_.source = source_.name;
    report_.source_format = source_.findings.format;
    report_.symmetrized = options_.symmetrize;
    if (options_.conserve_energy) brdf = conserved(std::get<FactoredBrdf>(brdf));
    if (options_.score) score(brdf);
    return {.brdf = std::move(brdf), .lambda_nm = source_.findings.lambda_nm, .report = std::move(report_)};
  }

 private:
  using Fitted = std::variant<FactoredBrdf, BaselineBrdf>;

  // ---- The forms

  Fitted fit(const OneLobe& form) { return fit_one(spec_of(form), form.how); }

  Fitted fit(const GivenLobes& form) {
    const ModelSpec spec = spec_of(form);
    const TrainingSet set = training_set(has_disk(spec));
    const RefineOptions refine = refine_options(form.loss);
    LobesReport report{.loss = form.loss};
    return finish(fit_lobes(set, spec, refine), set, refine, std::move(report));
  }

  Fitted fit(const Budget& form) {
    if (form.bytes && (*form.bytes == 0 || *form.bytes > kMaxBudget))
      throw Error(fmt::format("fit: expected a budget of 1 to {} bytes, found {}", kMaxBudget, *form.bytes));
    if (form.fetches.value_or(1) < 1)
      throw Error(fmt::format("fit: expected at least one fetch, found {}", *form.fetches));
    if (form.lobes.value_or(1) < 1)
      throw Error(fmt::format("fit: expected at least one lobe, found {}", *form.lobes));
    if (form.fetches && (form.lobes || form.search))
      throw Error("fit: expected with fetches neither a number of lobes nor a search");
    Budget budget = form;
    if (!form.bytes && !form.fetches && !form.lobes && !form.search) default_fetches_ = true;
    if (default_fetches_) budget.fetches = brdf_.isotropic() ? kIsotropicFetches : kAnisotropicFetches;
    return form.bytes ? fit_to_bytes(budget, *form.bytes) : fit_to_noise(budget);
  }

  Fitted fit(const DefaultBudget& form) {
    default_fetches_ = true;
    return fit(Budget{.bytes = kDefaultBudget, .loss = form.loss, .scattered = form.scattered});
  }

  FactoredBrdf fit_to_bytes(const Budget& form, std::uint64_t bytes) {
    // few scattered samples do not carry several lobes
    return scattered() ? fit_scattered(form, bytes) : fit_to_budget(form, bytes);
  }

  Fitted fit(const BaselineMethod& form) {
    if (options_.format || options_.smooth || options_.conserve_energy)
      throw Error(fmt::format(
          "fit: expected neither a format nor a smoothness nor energy conservation with method {}",
          form.method));
    if (form.bytes == std::uint64_t{0}) throw Error("fit: expected at least one byte for a method, found 0");
    const SampleSource samples = sample_source(kBaselineSamples, false);
    BaselineOptions options{.seed = options_.seed, .progress = progress(form.method)};
    if (form.bytes) options.budget = *form.bytes;
    BaselineFit fit = fit_baseline(reference(), samples, form.method, options);
    report_.how = BaselineReport{.method = std::move(fit.method),
                                 .budget = options.budget,
                                 .layouts_tried = fit.layouts_tried,
                                 .summary = fit.summary,
                                 .starts = fit.starts,
                                 .negative_lobes = {}};
    return std::move(fit.brdf);
  }

  Fitted fit(const FromBook& form) {
    if (options_.smooth || nodes_)
      throw Error("fit: expected neither a smoothness nor nodes as the target with a book");
    const TableFormat format = this->format();
    Completion completion =
        samples() ? complete(*form.book, *samples(), format)
                  : complete(*form.book,
                             measure(reference(), {.count = options_.samples.value_or(kBookSamples),
                                                   .seed = options_.seed}),
                             format);
    report_.how = std::move(completion.report);
    return std::move(completion.brdf);
  }

  // ---- One lobe

  ModelSpec spec_of(const OneLobe& form) const {
    ModelSpec spec = parse_model_spec(form.model, form.tables, brdf_.isotropic());
    if (spec.lobes.size() != 1)
      throw Error(
          fmt::format("fit: expected a model of one lobe, found {} in '{}'", spec.lobes.size(), form.model));
    return spec;
  }

  /// The paper's fit: one lobe, log-linear.
  FactoredBrdf fit_one(ModelSpec spec, const LogLinear& how) {
    const SampleSource source =
        sample_source(brdf_.isotropic() ? kIsotropicSamples : kAnisotropicSamples, has_disk(spec), table());
    HomomorphicOptions options = log_linear_options(how);
    if (options_.format) options.format = *options_.format;
    OneLobeReport report;

    // the smoothness: given, or the one that predicts best
    if (options_.smooth) {
      options.smooth = *options_.smooth;
    } else if (how.cross_validate || samples()) {
      const std::vector<SmoothTrial> trials = choose_smoothness(source, spec, options);
      options.smooth = trials.front().smooth;
      for (std::size_t t = 0; t < spec.tables.size(); ++t)
        spec.tables[t].smooth_share = trials.front().shares[t];
      if (source.distinct <= kManySamples) report.relative_cross_validated = std::expm1(trials.front().error);
    }
    return finish_one(source, source, spec, options, std::move(report));
  }

  /// The lobe for scattered samples that predicts best within the budget.
  FactoredBrdf fit_scattered(const Budget& form, std::uint64_t bytes) {
    // the lobe is reciprocal: samples exchanged would say the same again
    const SampleSource source = from_samples(*samples(), false);
    if (options_.format) check_format_of_source(*options_.format);
    HomomorphicOptions options = log_linear_options(form.scattered);
    if (backscatters(source)) {
      options.backscatter = kBackscatterReach;
      options.tolerance = kBackscatterTolerance;
    }
    const ScatteredPlan plan = plan_scattered(source, bytes, options_.smooth, options_.format, options,
                                              default_fetches_ ? 0 : form.fetches.value_or(0));
    options.smooth = plan.smooth;
    options.format = plan.format;
    OneLobeReport report;
    if (plan.error && !options_.smooth) report.relative_cross_validated = std::expm1(*plan.error);
    const Samples expected = expected_of(source, plan.spec, options);
    if (expected.size() == 0) return finish_one(source, source, plan.spec, options, std::move(report));
    const SampleSource both = with_expected(source, expected, kExpectedWeight);
    if (report.relative_cross_validated)  // of so little weight others count for nothing in it
      report.relative_cross_validated = std::expm1(held_out_error(both, plan.spec, options, kExpectedFolds));
    return finish_one(source, both, plan.spec, options, std::move(report));
  }

  /// What a first fit leads to expect between incidences; nothing of sources that do not backscatter.
  Samples expected_of(const SampleSource& source, const ModelSpec& spec,
                      const HomomorphicOptions& options) const {
    if (options.backscatter <= 0 || !source.isotropic) return {};
    return between_incidences(source, fit_homomorphic(source, spec, options).brdf);
  }

  HomomorphicOptions log_linear_options(const LogLinear& how) const {
    HomomorphicOptions options;
    options.floor = how.floor;
    options.reweightings = how.reweightings.value_or(samples() ? kScatteredReweightings : 0);
    options.progress = progress("fitting");
    return options;
  }

  /// Fits a lobe to `fitted`, which begins with the samples of `source`.
  FactoredBrdf finish_one(const SampleSource& source, const SampleSource& fitted, const ModelSpec& spec,
                          const HomomorphicOptions& options, OneLobeReport report) {
    HomomorphicFit result = fit_homomorphic(fitted, spec, options);
    report.summary = result.summary;
    report.samples = result.samples - (fitted.count - source.count);
    report.smooth = options.smooth;
    report.floor = options.floor;
    report.reweightings = result.reweightings;
    for (const ModelSpec::TableSpec& table : spec.tables)
      if (table.smooth_share != 1) report.smooth_shares.emplace_back(table.name, table.smooth_share);
    if (samples()) report.relative = std::expm1(log_error(source, result.brdf, options.error_floor).mean());
    report_.how = std::move(report);
    return std::move(result.brdf);
  }

  // ---- Several lobes

  ModelSpec spec_of(const GivenLobes& form) const {
    return parse_model_spec(form.model, form.tables, brdf_.isotropic());
  }

  FactoredBrdf fit_to_budget(Budget form, std::uint64_t bytes) {
    if (!form.fetches) check_budget(form, bytes);
    if (takes_knee(form))
      return brdf_.isotropic() ? fit_at_knee(form, bytes) : fit_hemispheres_at_knee(form, bytes);
    return !form.fetches                           ? fit_lobes_to(form, bytes)
           : judged_at_nodes() && default_fetches_ ? fit_nodes_within(form, bytes)
                                                   : fit_within(form, bytes);
  }

  /// Whether the number of fetches is left to choose. Where the order of the directions matters lobes share a table of
  /// wi and hold it better than the models of any trial.
  bool takes_knee(const Budget& form) const {
    return !form.fetches && !form.lobes && !form.search && !order_matters(reference());
  }

  /// By what models of an isotropic source do with few fetches and with many.
  FactoredBrdf fit_at_knee(Budget form, std::uint64_t bytes) {
    const CostLimit limit = limit_of(bytes, 0);
    const TrainingSet set = drawn_set(training_for_volumes(limit));
    std::vector<FetchTrial> trials = try_fetches(reference(), set, limit, refine_options(form.loss));
    if (!trials.empty())
      if (const FetchTrial& chosen = trial_at_knee(trials); !chosen.lobes) form.fetches = chosen.fetches;
    FactoredBrdf brdf = form.fetches ? fit_within(form, bytes) : fit_lobes_to(form, bytes);
    std::get<LobesReport>(report_.how).fetch_trials = std::move(trials);
    return brdf;
  }

  /// The same of an anisotropic one.
  FactoredBrdf fit_hemispheres_at_knee(const Budget& form, std::uint64_t bytes) {
    const CostLimit limit = limit_of(bytes, std::numeric_limits<int>::max());
    if (takes_lobes(reference(), limit)) return fit_lobes_to(form, bytes);
    LobesWay lobes = way_of_lobes(form, bytes);
    lobes.set = {};  // drawn again where lobes are chosen: one set in memory at a time
    TrainingSet set = drawn_set(training_for_hemispheres());
    RefineOptions trials = hemisphere_options(form.loss);
    trials.progress = progress("choosing fetches");
    FetchTrials tried = try_hemispheres(set, limit, trials, lobes.plan, lobes.refine);
    FactoredBrdf brdf = [&] {
      const FetchTrial* const chosen = tried.trials.empty() ? nullptr : &trial_at_knee(tried.trials);
      if (chosen && !chosen->lobes)
        return fit_hemispheres_to(form, bytes, std::move(set),
                                  tried.candidates[static_cast<std::size_t>(chosen - tried.trials.data())]);
      set = {};
      lobes.set = drawn_set(lobes.drawn);
      return fit_lobes_to(form, bytes, std::move(lobes));
    }();
    std::get<LobesReport>(report_.how).fetch_trials = std::move(tried.trials);
    return brdf;
  }

  CostLimit limit_of(std::uint64_t bytes, int fetches) const {
    return {.bytes = static_cast<std::size_t>(bytes),
            .texel_bytes = texel_bytes(format(), channels()),
            .fetches = fetches};
  }

  /// Which lobes of lines or hemispheres, and the pairs that they are fitted to.
  struct LobesWay {
    TrainingOptions drawn;
    TrainingSet set;
    RefineOptions refine;
    LobePlan plan;
  };
  LobesWay way_of_lobes(const Budget& form, std::uint64_t bytes) const {
    const std::size_t texel = texel_bytes(format(), channels());
    LobesWay way{.drawn = training_for(bytes, texel, brdf_.isotropic()),
                 .set = {},
                 .refine = refine_options(form.loss),
                 .plan = {}};
    way.drawn.seed = options_.seed;
    way.set = drawn_set(way.drawn);
    if (judged_at_nodes() && form.loss == FitLoss::image) way.refine.shares = kNodeShares;
    RefineOptions trials = way.refine;
    trials.progress = progress("choosing lobes");
    way.plan = plan_for(reference(), way.set, bytes, form.lobes.value_or(0), texel, trials);
    way.refine.smooth = smooth_of(way.plan, bytes, texel);
    return way;
  }

  FactoredBrdf fit_lobes_to(const Budget& form, std::uint64_t bytes) {
    return fit_lobes_to(form, bytes, way_of_lobes(form, bytes));
  }
  FactoredBrdf fit_lobes_to(const Budget& form, std::uint64_t bytes, LobesWay way) {
    const std::size_t texel = texel_bytes(format(), channels());
    auto& [drawn, set, refine, plan] = way;
    LobesReport report{.loss = form.loss, .budget = bytes};
    if (form.search) {
      const SearchResult found = search_plan(set, plan,
                                             {.bytes = static_cast<std::size_t>(bytes),
                                              .texel_bytes = texel,
                                              .refine = refine,
                                              .progress = progress("searching")});
      plan = found.plan;
      SearchReport& searched = report.search.emplace();
      searched.trials = found.trials.size();
      for (const SearchTrial& trial : found.trials)
        if (trial.kept) searched.kept.emplace_back(trial.change, trial.objective);
    }

    // and their tables, as smooth as asked for or as needed
    if (options_.smooth)
      return finish(fit_plan(set, plan, bytes, texel, refine, kLobeStarts), set, refine, std::move(report));
    const auto [fit, smooth] = fit_without_overfit(reference(), set, plan, bytes, texel, drawn, refine);
    report.smooth = refine.smooth = smooth;
    return finish(fit, set, refine, std::move(report));
  }

  /// How smooth lobes are: as asked for, or as serves them.
  double smooth_of(const LobePlan& plan, std::uint64_t bytes, std::size_t texel_bytes) const {
    const bool few = plan.lobes > 1 && plan.wide.empty() && bytes < kSpareTexels * texel_bytes;
    return options_.smooth.value_or(few ? kFewTexelsSmooth : RefineOptions().smooth);
  }

  /// Whether the bytes hold every table of the plan that they give.
  bool fits(const Budget& form, std::size_t bytes) const {
    const std::size_t texel = texel_bytes(format(), channels());
    if (form.fetches) return holds_model(reference(), limit_of(bytes, *form.fetches));
    return plan_fits(default_plan(bytes, form.lobes.value_or(0), brdf_.isotropic(), texel), bytes, channels(),
                     texel);
  }

  /// Throws Error unless they do.
  void check_budget(const Budget& form, std::uint64_t bytes) const {
    if (fits(form, bytes)) return;
    std::size_t most = bytes;
    while (!fits(form, most)) most *= 2;
    std::size_t least = most / 2;  // between what does not fit and what does
    while (most - least > 1) (fits(form, (least + most) / 2) ? most : least) = (least + most) / 2;
    throw Error(
        fmt::format("fit: expected a budget of at least {} bytes for {} channels in format {}, found {}",
                    most, channels(), to_string(format()), bytes));
  }

  /// More and more bytes, until the model errs no more than the measurement itself or they hardly help.
  FactoredBrdf fit_to_noise(const Budget& form) {
    if (scattered() && samples()->size() <= kManySamples) {
      FactoredBrdf brdf = fit_scattered(form, kBudgetLadder.back());
      report_.budget_choice = {.bytes = brdf.bytes(), .stop = BudgetStop::cross_validation};
      return brdf;
    }
    const NoiseScale scale = noise_scale();
    BudgetChoice choice{.noise = scale.noise()};
    std::optional<FactoredBrdf> best;
    decltype(report_.how) how_best;
    for (const std::uint64_t bytes : kBudgetLadder) {
      if (!scattered() && !fits(form, bytes)) continue;
      at_bytes_ = fmt::format(" to {} bytes", bytes);
      FactoredBrdf next = fit_to_bytes(form, bytes);
      const ErrorLevel error = scale.error_of(next);
      choice.trials.push_back({.bytes = bytes, .error = error, .excess = scale.excess(error)});
      const auto stop = stop_after(choice.trials, scale.noise().has_value());
      if (stop != BudgetStop::gain) {
        best = std::move(next);
        how_best = std::move(report_.how);
        choice.bytes = bytes;
      }
      if (!stop) continue;
      choice.stop = *stop;
      break;
    }
    if (!best) return fit_to_bytes(form, kBudgetLadder.back());  // which says how many bytes it takes
    report_.how = std::move(how_best);
    report_.budget_choice = std::move(choice);
    return std::move(*best);
  }

  NoiseScale noise_scale() const {
    if (nodes_) return {*nodes_, report_.nodes->held_out};
    if (const Samples* all = samples()) return {measured_nodes(*all), {}};
    return {source_, reference(), options_.symmetrize, held_out_of_factors()};
  }

  /// Within a number of fetches: lobes of lines or hemispheres, or one lobe with a volume.
  FactoredBrdf fit_within(const Budget& form, std::uint64_t bytes) {
    const CostLimit limit = limit_of(bytes, *form.fetches);
    LobesReport report{.loss = form.loss, .budget = bytes, .fetches = *form.fetches};
    RefineOptions refine = refine_options(form.loss);
    if (takes_lobes(reference(), limit)) {
      const TrainingSet set = drawn_set(training_for(bytes, limit.texel_bytes, brdf_.isotropic()));
      const LobePlan plan = plan_within(reference(), limit);
      refine.smooth = smooth_of(plan, bytes, limit.texel_bytes);
      return finish(fit_plan(set, plan, limit.bytes, limit.texel_bytes, refine, kLobeStarts), set, refine,
                    std::move(report));
    }
    if (!brdf_.isotropic())
      return fit_hemispheres_to(form, bytes, drawn_set(training_for_hemispheres()),
                                hemisphere_specs(limit, channels()));
    if (form.loss == FitLoss::image) {
      refine.shares = kVolumeShares;
      if (*form.fetches >= kSpareFetches) {
        refine.shares.log_cos = kSpareLogCos;
        if (bytes >= kSpareTexels * limit.texel_bytes) refine.shares.absolute = kSpareAbsolute;
      }
      if (judged_at_nodes()) refine.shares = kNodeShares;
    }
    if (!options_.smooth) {
      refine.smooth = kVolumeSmooth;
      if (form.scattered.cross_validate && !nodes_ && is_measurement(source_))
        report.smooth = refine.smooth = volume_smoothness(limit);
    }
    const TrainingSet set = drawn_set(training_for_volumes(limit));
    return finish(fit_volumes(set, volume_specs(reference(), limit), refine), set, refine, std::move(report));
  }

  RefineOptions hemisphere_options(FitLoss loss) const {
    RefineOptions refine = refine_options(loss);
    if (!options_.smooth) refine.smooth = kHemisphereSmooth;
    if (loss == FitLoss::image) refine.shares = kVolumeShares;
    return refine;
  }

  /// `from`: the specs to choose from, or the candidate that was chosen. The steps at all pairs look at albedos too.
  FactoredBrdf fit_hemispheres_to(const Budget& form, std::uint64_t bytes, TrainingSet set,
                                  const auto& from) {
    RefineOptions refine = hemisphere_options(form.loss);
    if (counts_albedos(form.loss)) add_albedos(set, refine);
    const LobesFit fit = fit_hemispheres(set, from, refine);
    return rounded(fit, set, refine,
                   {.loss = form.loss, .budget = bytes, .fetches = form.fetches.value_or(0)});
  }

  /// Nodes that are given no number of fetches: one more where fewer leave a model farther from them than what is
  /// measured foretells nodes that it has not seen, and where it helps.
  FactoredBrdf fit_nodes_within(Budget form, std::uint64_t bytes) {
    FactoredBrdf fewer = fit_within(form, bytes);
    const NodeFigures near = node_figures(*nodes_, fewer), &unseen = *report_.nodes->held_out;
    if (near.relative <= kFarther * unseen.relative && near.log_cos <= kFarther * unseen.log_cos)
      return fewer;
    *form.fetches += kMoreFetchesOfNodes;
    if (!holds_model(reference(), limit_of(bytes, *form.fetches))) return fewer;
    auto how = report_.how;
    const std::string at_bytes =
        std::exchange(at_bytes_, at_bytes_ + fmt::format(", {} fetches", *form.fetches));
    FactoredBrdf more = fit_within(form, bytes);
    at_bytes_ = at_bytes;
    const NodeFigures nearer = node_figures(*nodes_, more);
    if (nearer.relative * nearer.log_cos < near.relative * near.log_cos) return more;
    report_.how = std::move(how);
    return fewer;
  }

  /// That which predicts nodes best, judged by a model of few fetches.
  double volume_smoothness(CostLimit limit) const {
    limit.fetches = std::min(limit.fetches, kSmoothnessFetches);
    const std::vector<ModelSpec> specs = volume_specs(reference(), limit);
    return choose_volume_smoothness(measured_nodes(source_), specs.front(), options_.symmetrize);
  }

  /// Pairs drawn from what is fitted, or the scattered samples themselves; with the nodes that are the target.
  TrainingSet drawn_set(TrainingOptions drawn) const {
    drawn.seed = options_.seed;
    if (samples()) return training_set_of(at_most(kMostScattered, *samples()), options_.symmetrize);
    if (const auto sampling = progress("sampling")) sampling(0);
    TrainingSet set = with_frontal_pixels(reference(), draw_training_set(reference(), drawn), kFrontalShare);
    if (judged_at_nodes()) add_nodes(set);
    return set;
  }

  /// Adds the function's values at the nodes, which crowd where highlights are, as pairs that together weigh what the
  /// others do.
  void add_nodes(TrainingSet& set) const {
    const double others = std::accumulate(
        set.weights.begin() + static_cast<std::ptrdiff_t>(set.picture_count), set.weights.end(), 0.0);
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < nodes_->size(); ++i)
      if (std::min(nodes_->samples.pairs[i].wi.z, nodes_->samples.pairs[i].wo.z) > NodeScoring{}.least_cosine)
        near.push_back(i);
    std::vector<double> f(set.channels);
    for (const std::size_t i : near) {
      const DirectionPair& pair = nodes_->samples.pairs[i];
      between_->eval(pair.wi, pair.wo, f);
      set.pairs.push_back(pair);
      set.weights.push_back(static_cast<float>(others / static_cast<double>(near.size())));
      for (const double value : f) set.values.push_back(static_cast<float>(value));
    }
  }

  bool counts_albedos(FitLoss loss) const { return !samples() && loss == FitLoss::image; }

  void add_albedos(TrainingSet& set, RefineOptions& refine) const {
    set.albedo = albedo_set(reference());
    refine.shares.albedo = kAlbedoShare;
  }

  /// Last steps that look at albedos too. Before, they would lead lobes that are not found yet astray.
  void reflect_as_much(LogModel& model, TrainingSet& set, RefineOptions& refine) const {
    add_albedos(set, refine);
    RefineOptions steps = refine;
    const bool direct = coupled_unknowns(model.spec, channels()) <= kMaxCholeskyUnknowns;
    steps.max_iterations = direct ? kAlbedoSteps : kLongAlbedoSteps;
    steps.progress = progress("matching albedos");
    burnish::refine(model, set, steps);
  }

  FactoredBrdf finish(LobesFit fit, TrainingSet set, RefineOptions refine, LobesReport report) {
    if (counts_albedos(report.loss)) reflect_as_much(fit.model, set, refine);
    return rounded(fit, set, refine, std::move(report));
  }

  FactoredBrdf rounded(const LobesFit& fit, const TrainingSet& set, const RefineOptions& refine,
                       LobesReport report) {
    report.summary = fit.summary;
    report.samples = set.size();
    report.lobes = fit.model.spec.lobes.size();
    report_.how = std::move(report);
    return to_rounded_brdf(fit.model, set, refine);
  }

  RefineOptions refine_options(FitLoss loss) const {
    RefineOptions options{.format = format()};
    if (loss == FitLoss::relative) options.shares = {.relative = 1};
    if (loss == FitLoss::log_cos) options.shares = {.relative = 0.1, .log_cos = 1};
    if (options_.smooth) options.smooth = *options_.smooth;
    options.progress = progress("fitting");
    return options;
  }

  /// Three channels share an exponent unless told otherwise: a third fewer bytes for hardly any error.
  TableFormat format() const {
    if (!options_.format) return channels() == 3 ? TableFormat::rgb9e5 : TableFormat::half;
    check_format_of_source(*options_.format);
    return *options_.format;
  }

  void check_format_of_source(TableFormat format) const {
    if (!holds_channels(format, channels()))
      throw Error(
          fmt::format("format {}: expected a source of 3 channels, found {}", to_string(format), channels()));
  }

  // ---- What is fitted

  std::size_t channels() const { return brdf_.channels(); }
  /// Samples that are fitted as they are.
  const Samples* samples() const {
    if (between_) return nullptr;
    return nodes_ ? &nodes_->samples : source_.samples();
  }
  /// Whether those are scattered samples of the source.
  bool scattered() const { return samples() && !nodes_; }
  /// Whether a fit follows the function between nodes most where these are: a table's crowd where highlights are.
  /// Scattered samples stand anywhere, and their function is fitted as any other.
  bool judged_at_nodes() const { return between_ && !source_.samples(); }
  const HalfDiffTable* table() const { return nodes_ ? nullptr : std::get_if<HalfDiffTable>(&source_.brdf); }
  BrdfRef reference() const {
    if (between_) return *between_;
    return symmetrized_ ? BrdfRef(*symmetrized_) : brdf_;
  }

  /// The nodes to be fitted and, of an isotropic source, the function between them.
  void take_nodes() {
    nodes_ = measured_nodes(source_);
    if (options_.hold_out) nodes_ = nodes_without(*nodes_, *options_.hold_out);
    const std::size_t measured = nodes_->size();
    if (source_.samples()) nodes_ = without_outliers(*std::move(nodes_));
    NodesReport& report =
        report_.nodes.emplace(NodesReport{.fitted = nodes_->size(), .outliers = measured - nodes_->size()});
    if (!nodes_->samples.isotropic) return;
    const auto told = progress("kriging the nodes");
    report.covariance = choose_covariance(*nodes_, told);
    report.held_out = held_out_figures(*nodes_, *report.covariance);
    const BrdfRef function = symmetrized_ ? BrdfRef(*symmetrized_) : brdf_;
    if (source_.samples())
      between_.emplace(*nodes_, *report.covariance);
    else
      between_.emplace(with_gaps_filled(*nodes_, measured_nodes(source_), function), *report.covariance);
    if (told) told(1);
  }

  /// The source's own samples where it has some, a table's entries where one is given, else pairs drawn.
  SampleSource sample_source(std::size_t drawn, bool spread_phi_h,
                             const HalfDiffTable* table = nullptr) const {
    if (samples()) return from_samples(*samples(), options_.symmetrize);
    if (table) return from_table(*table, options_.symmetrize, spread_phi_h);
    return from_brdf(reference(), options_.samples.value_or(drawn), options_.seed, spread_phi_h);
  }

  TrainingSet training_set(bool spread_phi_h) const {
    if (samples()) return training_set_of(*samples(), options_.symmetrize);
    TrainingOptions drawn = training_for(0, 1, brdf_.isotropic());
    drawn.seed = options_.seed;
    drawn.spread_phi_h = spread_phi_h;
    return with_frontal_pixels(reference(), draw_training_set(reference(), drawn), kFrontalShare);
  }

  // ---- What became of it

  FigureOptions held_out() const { return {.count = kHeldOutPairs, .seed = options_.seed + 1}; }
  FigureOptions held_out_of_factors() const {
    FigureOptions figures = held_out();
    figures.image_size = kHeldOutSphereSize;
    return figures;
  }

  /// Takes out of the model what it reflects too much, and reports what that cost.
  FactoredBrdf conserved(const FactoredBrdf& brdf) {
    EnergyConservation kept = burnish::conserve_energy(brdf);
    const Scorer scorer(reference(), held_out_of_factors());
    report_.energy = {.largest_albedo_before = std::ranges::max(kept.largest_before),
                      .largest_albedo_after = std::ranges::max(kept.largest_after),
                      .iterations = kept.iterations,
                      .before = scorer.score(brdf),
                      .after = scorer.score(kept.brdf)};
    return std::move(kept.brdf);
  }

  /// After rounding to the table format, on pairs that were not fitted.
  void score(const Fitted& fitted) {
    if (report_.nodes) {
      const BrdfRef brdf = std::visit([](const auto& any) { return ref_of(any); }, fitted);
      report_.nodes->at_fitted = node_figures(*nodes_, brdf);
      if (options_.hold_out)
        report_.nodes->at_held_out =
            node_figures(nodes_of(measured_nodes(source_), *options_.hold_out), brdf);
      if (between_ && brdf.channels() == between_->channels())
        report_.nodes->expected = expected_error(*between_, brdf);
    }
    if (const auto* baseline = std::get_if<BaselineBrdf>(&fitted)) {
      const Scorer scorer(reference(), held_out());
      report_.held_out = scorer.score(baseline_ref(*baseline));
      auto& report = std::get<BaselineReport>(report_.how);
      if (report.method == "svd")
        report.negative_lobes = negative_lobes(std::get<SeparableBrdf>(*baseline), scorer);
    } else if (!samples()) {
      report_.held_out = error_figures(reference(), std::get<FactoredBrdf>(fitted), held_out_of_factors());
    }
  }

  std::function<void(double)> progress(std::string stage) const {
    if (!options_.progress) return nullptr;
    stage += at_bytes_;
    return [this, stage = std::move(stage)](double fraction) { options_.progress(stage, fraction); };
  }

  const Source& source_;
  const FitOptions& options_;
  BrdfRef brdf_;
  std::optional<SymmetrizedBrdf> symmetrized_;
  std::optional<MeasuredNodes> nodes_;
  std::optional<KrigedNodes> between_;  ///< the function between nodes of an isotropic source
  FitReport report_;
  bool default_fetches_ = false;  ///< nobody gave a number of fetches: they are those of DefaultBudget
  std::string at_bytes_;          ///< of a stage of progress, where several numbers of bytes are tried
};

}  // namespace

FitTarget parse_fit_target(std::string_view text) {
  if (text == "function") return FitTarget::function;
  if (text == "nodes") return FitTarget::nodes;
  throw Error(fmt::format("target: expected function or nodes, found '{}'", text));
}

std::string_view to_string(FitTarget target) noexcept {
  return target == FitTarget::nodes ? "nodes" : "function";
}

FitTarget default_target(const Source& source, const FitOptions& options) {
  if (options.hold_out) return FitTarget::nodes;
  const auto* table = std::get_if<RglTable>(&source.brdf);
  const auto* budget = options.form ? std::get_if<Budget>(&*options.form) : nullptr;
  const auto* usual = options.form ? std::get_if<DefaultBudget>(&*options.form) : nullptr;
  const LogLinear one_lobe = budget ? budget->scattered : usual ? usual->scattered : LogLinear{};
  const bool given = options.form && std::holds_alternative<GivenLobes>(*options.form);
  const bool chosen = (!options.form || budget || usual) && !one_lobe.cross_validate;

  // Scattered samples say more than a function made of them, but for peaks about wi = wo, which a lobe of their own
  // holds, and for few anisotropic ones, which leave the tables of several lobes undetermined. Options of one lobe ask
  // for one.
  const auto takes_samples = [&](const Samples& samples) {
    return (samples.isotropic || samples.size() >= kFewAnisotropic) && chosen && !one_lobe.reweightings &&
           one_lobe.floor == LogLinear{}.floor && !backscatters(from_samples(samples, false));
  };
  const Samples* samples = source.samples();
  const bool measured = table ? table->isotropic() && (given || chosen) : samples && takes_samples(*samples);
  return measured && options.symmetrize ? FitTarget::nodes : FitTarget::function;
}

FitForm form_of(const std::string& model, const std::vector<std::string>& tables, bool isotropic,
                const LogLinear& of_one_lobe, FitLoss of_several) {
  if (model.empty()) {
    if (!tables.empty()) return form_of(OneLobe{}.model, tables, isotropic, of_one_lobe, of_several);
    return DefaultBudget{.loss = of_several, .scattered = of_one_lobe};
  }
  if (parse_model_spec(model, tables, isotropic).lobes.size() == 1)
    return OneLobe{.model = model, .tables = tables, .how = of_one_lobe};
  return GivenLobes{.model = model, .tables = tables, .loss = of_several};
}

const FactoredBrdf& Fit::model() const& {
  if (const auto* model = std::get_if<FactoredBrdf>(&brdf)) return *model;
  throw no_model();
}

FactoredBrdf Fit::model() && {
  if (auto* model = std::get_if<FactoredBrdf>(&brdf)) return std::move(*model);
  throw no_model();
}

BrdfRef Fit::ref() const noexcept {
  const auto* model = std::get_if<FactoredBrdf>(&brdf);
  return model ? BrdfRef(*model) : baseline_ref(std::get<BaselineBrdf>(brdf));
}

std::size_t Fit::bytes() const noexcept {
  const auto* model = std::get_if<FactoredBrdf>(&brdf);
  return model ? model->bytes() : baseline_bytes(std::get<BaselineBrdf>(brdf));
}

Fit fit(const Source& source, const FitOptions& options) {
  return Fitter(source, options).run();
}

}  // namespace burnish
