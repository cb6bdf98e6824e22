#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/baselines/negative_lobes.h>
#include <burnish/fitting/energy.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/one_lobe/cross_validation.h>
#include <burnish/fitting/one_lobe/log_error.h>
#include <burnish/fitting/plans/fetch_plan.h>
#include <burnish/fitting/plans/fit_plan.h>
#include <burnish/fitting/plans/overfit.h>
#include <burnish/fitting/plans/search.h>
#include <burnish/fitting/refinement/rounding.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

namespace {

// Scattered samples are few and noisy: they are fitted robustly, with the smoothness that predicts best.
constexpr int kScatteredReweightings = 4;

// Pairs drawn for one lobe from a source that is a function; an anisotropic one has one dimension more.
constexpr std::size_t kIsotropicSamples = 200'000, kAnisotropicSamples = 500'000;
constexpr std::size_t kBaselineSamples = 200'000;

// Pairs that the fit did not see, for the error that is reported.
constexpr std::size_t kHeldOutPairs = 20'000;
constexpr int kHeldOutSphereSize = 128;  // of a baseline's the defaults of FigureOptions

// Volumes follow all angles alike; what they lack shows in pictures first. With p(wo) p(wi) beside them, of four
// fetches, there is some to spare.
constexpr ErrorTerms kVolumeShares{.pictures = 3, .dimmed = 0.3, .relative = 0.5, .log_cos = 0.5};
constexpr int kSpareFetches = 4;
constexpr double kSpareLogCos = 0.8;
constexpr double kVolumeSmooth = 1e-9;
constexpr double kFrontalShare = 0.1;  // of pixels, see with_frontal_pixels

bool has_disk(const ModelSpec& spec) {
  return std::ranges::any_of(spec.tables,
                             [](const auto& table) { return table.layout.shape == TableShape::disk; });
}

Error no_model() {
  return Error("fit: expected a product of tables, found a baseline");
}

/// One fit of one source.
class Fitter {
 public:
  Fitter(const Source& source, const FitOptions& options)
      : source_(source), options_(options), brdf_(source.ref()) {
    if (options.symmetrize) symmetrized_.emplace(brdf_);
  }
  Fitter(const Fitter&) = delete;

  Fit run() {
    const auto start = std::chrono::steady_clock::now();
    auto brdf = std::visit([&](const auto& form) { return fit(form); }, options_.form);
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
    if (form.bytes == 0) throw Error("fit: expected a budget of at least one byte, found none");
    if (form.fetches < 0 || (form.fetches > 0 && (form.lobes > 0 || form.search)))
      throw Error("fit: expected fetches >= 0, and with them neither a number of lobes nor a search");
    // few scattered samples do not carry several lobes
    return samples() ? fit_one(one_lobe_of(form), form.scattered) : fit_to_budget(form);
  }

  Fitted fit(const BaselineMethod& form) {
    if (options_.format || options_.smooth || options_.conserve_energy)
      throw Error(fmt::format(
          "fit: expected neither a format nor a smoothness nor energy conservation with method {}",
          form.method));
    const SampleSource samples = sample_source(kBaselineSamples, false);
    BaselineOptions options{.seed = options_.seed, .progress = progress(form.method)};
    if (form.bytes > 0) options.budget = form.bytes;
    BaselineFit fit = fit_baseline(reference(), samples, form.method, options);
    report_.how = BaselineReport{.method = std::move(fit.method),
                                 .budget = options.budget,
                                 .layouts_tried = fit.layouts_tried,
                                 .summary = fit.summary,
                                 .starts = fit.starts,
                                 .negative_lobes = {}};
    return std::move(fit.brdf);
  }

  // ---- One lobe

  ModelSpec spec_of(const OneLobe& form) const {
    ModelSpec spec = parse_model_spec(form.model, form.tables, brdf_.isotropic());
    if (spec.lobes.size() != 1)
      throw Error(
          fmt::format("fit: expected a model of one lobe, found {} in '{}'", spec.lobes.size(), form.model));
    return spec;
  }

  /// The lobe of a budget's plan without what is spread wide.
  ModelSpec one_lobe_of(const Budget& form) const {
    const std::size_t texel = texel_bytes(format(), channels());
    const bool isotropic = brdf_.isotropic();
    LobePlan plan = default_plan(form.bytes, isotropic ? 1 : 2, isotropic, texel);
    plan.wide.clear();
    plan.wide_texels = 0;
    return plan_to_spec(plan, form.bytes, channels(), texel);
  }

  /// The paper's fit: one lobe, log-linear.
  FactoredBrdf fit_one(ModelSpec spec, const LogLinear& how) {
    const SampleSource source =
        sample_source(brdf_.isotropic() ? kIsotropicSamples : kAnisotropicSamples, has_disk(spec), table());
    HomomorphicOptions options;
    options.floor = how.floor;
    if (options_.format) options.format = *options_.format;
    options.reweightings = how.reweightings.value_or(samples() ? kScatteredReweightings : 0);
    options.progress = progress("fitting");
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

    HomomorphicFit result = fit_homomorphic(source, spec, options);
    report.summary = result.summary;
    report.samples = result.samples;
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

  FactoredBrdf fit_to_budget(const Budget& form) {
    if (form.fetches > 0) return fit_within(form);
    const std::size_t texel = texel_bytes(format(), channels());
    TrainingOptions drawn = training_for(form.bytes, texel, brdf_.isotropic());
    drawn.seed = options_.seed;
    const TrainingSet set = draw_training_set(reference(), drawn);
    RefineOptions refine = refine_options(form.loss);
    LobesReport report{.loss = form.loss, .budget = form.bytes};

    // which lobes
    RefineOptions trials = refine;
    trials.progress = progress("choosing lobes");
    LobePlan plan = plan_for(reference(), set, form.bytes, form.lobes, texel, trials);
    if (form.search) {
      const SearchResult found = search_plan(
          set, plan,
          {.bytes = form.bytes, .texel_bytes = texel, .refine = refine, .progress = progress("searching")});
      plan = found.plan;
      SearchReport& searched = report.search.emplace();
      searched.trials = found.trials.size();
      for (const SearchTrial& trial : found.trials)
        if (trial.kept) searched.kept.emplace_back(trial.change, trial.objective);
    }

    // and their tables, as smooth as asked for or as needed
    if (options_.smooth)
      return finish(fit_plan(set, plan, form.bytes, texel, refine), set, refine, std::move(report));
    const LobesFit fit = fit_without_overfit(reference(), set, plan, form.bytes, texel, drawn, refine);
    report.smooth = refine.smooth;
    return finish(fit, set, refine, std::move(report));
  }

  /// Within a number of fetches: lobes of lines or hemispheres, or one lobe with a volume.
  FactoredBrdf fit_within(const Budget& form) {
    const CostLimit limit{
        .bytes = form.bytes, .texel_bytes = texel_bytes(format(), channels()), .fetches = form.fetches};
    LobesReport report{.loss = form.loss, .budget = form.bytes, .fetches = form.fetches};
    RefineOptions refine = refine_options(form.loss);
    if (takes_lobes(reference(), limit)) {
      TrainingOptions drawn = training_for(form.bytes, limit.texel_bytes, brdf_.isotropic());
      drawn.seed = options_.seed;
      const TrainingSet set = draw_training_set(reference(), drawn);
      const LobePlan plan = plan_within(reference(), limit);
      return finish(fit_plan(set, plan, limit.bytes, limit.texel_bytes, refine), set, refine,
                    std::move(report));
    }
    if (!brdf_.isotropic()) {
      const ModelSpec spec = hemisphere_spec(limit, channels());
      TrainingOptions drawn = training_for(form.bytes, limit.texel_bytes, false);
      drawn.seed = options_.seed;
      const TrainingSet set = draw_training_set(reference(), drawn);
      return finish(fit_lobes(set, spec, refine), set, refine, std::move(report));
    }
    if (form.loss == FitLoss::image) {
      refine.shares = kVolumeShares;
      if (form.fetches >= kSpareFetches) refine.shares.log_cos = kSpareLogCos;
    }
    if (!options_.smooth) refine.smooth = kVolumeSmooth;
    TrainingOptions drawn = training_for_volumes(limit);
    drawn.seed = options_.seed;
    const TrainingSet set =
        with_frontal_pixels(reference(), draw_training_set(reference(), drawn), kFrontalShare);
    return finish(fit_volumes(set, volume_specs(reference(), limit), refine), set, refine, std::move(report));
  }

  FactoredBrdf finish(const LobesFit& fit, const TrainingSet& set, const RefineOptions& refine,
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
    if (!holds_channels(*options_.format, channels()))
      throw Error(fmt::format("format {}: expected a source of 3 channels, found {}",
                              to_string(*options_.format), channels()));
    return *options_.format;
  }

  // ---- What is fitted

  int channels() const { return brdf_.channels(); }
  const Samples* samples() const { return source_.samples(); }
  const HalfDiffTable* table() const { return std::get_if<HalfDiffTable>(&source_.brdf); }
  BrdfRef reference() const { return symmetrized_ ? BrdfRef(*symmetrized_) : brdf_; }

  /// The source's own samples where it has some, a table's entries where one is given, else pairs drawn.
  SampleSource sample_source(std::size_t drawn, bool spread_phi_h,
                             const HalfDiffTable* table = nullptr) const {
    if (samples()) return from_samples(*samples(), options_.symmetrize);
    if (table) return from_table(*table, options_.symmetrize, spread_phi_h);
    return from_brdf(reference(), options_.samples > 0 ? options_.samples : drawn, options_.seed,
                     spread_phi_h);
  }

  TrainingSet training_set(bool spread_phi_h) const {
    if (samples()) return training_set_of(*samples(), options_.symmetrize);
    TrainingOptions drawn = training_for(0, 1, brdf_.isotropic());
    drawn.seed = options_.seed;
    drawn.spread_phi_h = spread_phi_h;
    return draw_training_set(reference(), drawn);
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
    return [this, stage = std::move(stage)](double fraction) { options_.progress(stage, fraction); };
  }

  const Source& source_;
  const FitOptions& options_;
  BrdfRef brdf_;
  std::optional<SymmetrizedBrdf> symmetrized_;
  FitReport report_;
};

}  // namespace

FitForm form_of(const std::string& model, const std::vector<std::string>& tables, bool isotropic,
                const LogLinear& of_one_lobe, FitLoss of_several) {
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
