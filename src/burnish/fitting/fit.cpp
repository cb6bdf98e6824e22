#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/fitting/energy.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/one_lobe/cross_validation.h>
#include <burnish/fitting/one_lobe/log_error.h>
#include <burnish/fitting/plans/fit_plan.h>
#include <burnish/fitting/plans/overfit.h>
#include <burnish/fitting/plans/search.h>
#include <burnish/fitting/refinement/rounding.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

namespace {

using Json = nlohmann::ordered_json;

// Scattered samples are few and noisy: they are fitted robustly, with the smoothness that predicts best.
constexpr int kScatteredReweightings = 4;

// Pairs drawn for one lobe from a source that is a function; an anisotropic one has one dimension more.
constexpr std::size_t kIsotropicSamples = 200'000, kAnisotropicSamples = 500'000;

// Pairs that the fit did not see, for the error that is noted.
constexpr std::size_t kHeldOutPairs = 20'000;

class Fitter {
 public:
  Fitter(const FitInput& input, const FitOptions& options) : input_(input), options_(options) {
    if (options.symmetrize) symmetrized_.emplace(input.brdf);
    notes_ = {{"source", input.name}, {"source_format", input.format}, {"symmetrized", options.symmetrize}};
  }
  Fitter(const Fitter&) = delete;

  Model run() {
    FactoredBrdf brdf = fit();
    const FigureOptions figures{.count = kHeldOutPairs, .seed = options_.seed + 1, .image_size = 128};
    if (options_.conserve_energy) conserve(figures, brdf);
    // After rounding to the table format, on pairs that were not fitted.
    if (!input_.samples) {
      const ErrorFigures error = error_figures(reference(), brdf, figures);
      notes_["psnr"] = std::isfinite(error.psnr) ? Json(error.psnr) : Json();
      notes_["ssim"] = error.ssim;
      notes_["relative"] = error.relative;
      notes_["rms_log"] = error.rms_log;
      notes_["log_cos"] = error.log_cos;
    }
    // File names need not be UTF-8.
    return {.brdf = std::move(brdf),
            .lambda_nm = input_.lambda_nm,
            .notes = notes_.dump(-1, ' ', false, Json::error_handler_t::replace)};
  }

 private:
  BrdfRef reference() const { return symmetrized_ ? BrdfRef(*symmetrized_) : input_.brdf; }

  std::function<void(double)> progress(const char* stage) const {
    if (!options_.progress) return nullptr;
    return [this, stage](double fraction) { options_.progress(stage, fraction); };
  }

  FactoredBrdf fit() {
    if (options_.budget > 0) {
      // few scattered samples do not carry several lobes
      return input_.samples ? fit_one(one_lobe_of_budget()) : fit_to_budget();
    }
    ModelSpec spec = parse_model_spec(options_.model, options_.tables, input_.brdf.isotropic());
    return spec.lobes.size() == 1 ? fit_one(std::move(spec)) : fit_several(spec);
  }

  // The paper's fit: one lobe, log-linear.
  FactoredBrdf fit_one(ModelSpec spec) {
    const SampleSource samples = sample_source(has_disk(spec));
    HomomorphicOptions options;
    options.floor = options_.floor;
    if (options_.format) options.format = *options_.format;
    options.reweightings = options_.reweightings.value_or(input_.samples ? kScatteredReweightings : 0);
    options.progress = progress("fitting");
    std::optional<double> cross_validated;
    if (options_.smooth) {
      options.smooth = *options_.smooth;
    } else if (options_.cross_validate || input_.samples) {
      const std::vector<SmoothTrial> trials = choose_smoothness(samples, spec, options);
      options.smooth = trials.front().smooth;
      for (std::size_t t = 0; t < spec.tables.size(); ++t)
        spec.tables[t].smooth_share = trials.front().shares[t];
      if (samples.distinct <= kManySamples) cross_validated = trials.front().error;
    }
    HomomorphicFit result = fit_homomorphic(samples, spec, options);
    const HomomorphicSummary& summary = result.summary;
    notes_["samples"] = summary.samples;
    notes_["smooth"] = options.smooth;
    notes_["floor"] = options.floor;
    notes_["reweightings"] = summary.reweightings;
    notes_["rms_log_before"] = summary.error_before;
    notes_["rms_log_after"] = summary.error_after;
    notes_["iterations"] = summary.iterations;
    notes_["stop_reason"] = summary.stop_reason;
    for (const ModelSpec::TableSpec& table : spec.tables)
      if (table.smooth_share != 1) notes_["smooth_shares"][table.name] = table.smooth_share;
    if (input_.samples)
      notes_["relative"] = std::expm1(log_error(samples, result.brdf, options.error_floor).mean());
    if (cross_validated) notes_["relative_cross_validated"] = std::expm1(*cross_validated);
    return std::move(result.brdf);
  }

  FactoredBrdf fit_several(const ModelSpec& spec) {
    const TrainingSet set = training_set(has_disk(spec));
    const RefineOptions refine = refine_options();
    return finish(fit_lobes(set, spec, refine), set, refine);
  }

  FactoredBrdf fit_to_budget() {
    const std::size_t texel = texel_bytes(format(), channels());
    TrainingOptions drawn = training_for(options_.budget, texel, input_.brdf.isotropic());
    drawn.seed = options_.seed;
    const TrainingSet set = draw_training_set(reference(), drawn);
    RefineOptions refine = refine_options();
    RefineOptions trials = refine;
    trials.progress = progress("choosing lobes");
    LobePlan plan = plan_for(reference(), set, options_.budget, options_.lobes, texel, trials);
    if (options_.search) {
      const SearchResult found = search_plan(set, plan,
                                             {.bytes = options_.budget,
                                              .texel_bytes = texel,
                                              .refine = refine,
                                              .progress = progress("searching")});
      plan = found.plan;
      Json kept = Json::array();
      for (const SearchTrial& trial : found.trials)
        if (trial.kept) kept.push_back({{"change", trial.change}, {"objective", trial.objective}});
      notes_["search"] = {{"trials", found.trials.size()}, {"kept", std::move(kept)}};
    }
    notes_["budget"] = options_.budget;
    if (options_.smooth) return finish(fit_plan(set, plan, options_.budget, texel, refine), set, refine);
    const LobesFit fit = fit_without_overfit(reference(), set, plan, options_.budget, texel, drawn, refine);
    notes_["smooth"] = refine.smooth;
    return finish(fit, set, refine);
  }

  ModelSpec one_lobe_of_budget() const {
    const std::size_t texel = texel_bytes(format(), channels());
    const bool isotropic = input_.brdf.isotropic();
    LobePlan plan = default_plan(options_.budget, isotropic ? 1 : 2, isotropic, texel);
    plan.wide.clear();
    plan.wide_texels = 0;
    return plan_to_spec(plan, options_.budget, channels(), texel);
  }

  FactoredBrdf finish(const LobesFit& fit, const TrainingSet& set, const RefineOptions& refine) {
    constexpr const char* kLossNames[] = {"image", "relative", "log_cos"};
    notes_["samples"] = set.size();
    notes_["lobes"] = fit.summary.lobes;
    notes_["loss"] = kLossNames[static_cast<std::size_t>(options_.loss)];
    notes_["iterations"] = fit.summary.iterations;
    notes_["stop_reason"] = fit.summary.stop_reason;
    notes_["objective"] = fit.summary.objective_after;
    return to_rounded_brdf(fit.model, set, refine);
  }

  // Takes out of the model what it reflects too much, and notes what that cost.
  void conserve(const FigureOptions& figures, FactoredBrdf& brdf) {
    EnergyConservation kept = burnish::conserve_energy(brdf);
    Json& note = notes_["conserve_energy"];
    note = {{"largest_albedo_before", std::ranges::max(kept.largest_before)},
            {"largest_albedo_after", std::ranges::max(kept.largest_after)},
            {"iterations", kept.iterations}};
    const Scorer scorer(reference(), figures);
    for (const auto& [when, model] : {std::pair("before", &brdf), std::pair("after", &kept.brdf)}) {
      const ErrorFigures error = scorer.score(*model);
      note[fmt::format("psnr_{}", when)] = error.psnr;
      note[fmt::format("relative_{}", when)] = error.relative;
    }
    brdf = std::move(kept.brdf);
  }

  static bool has_disk(const ModelSpec& spec) {
    return std::ranges::any_of(spec.tables,
                               [](const auto& table) { return table.layout.shape == TableShape::disk; });
  }

  int channels() const { return input_.brdf.channels(); }

  // Three channels share an exponent unless told otherwise: a third fewer bytes for hardly any error.
  TableFormat format() const {
    if (!options_.format) return channels() == 3 ? TableFormat::rgb9e5 : TableFormat::half;
    if (!holds_channels(*options_.format, channels()))
      throw Error(fmt::format("format {}: expected a source of 3 channels, found {}",
                              to_string(*options_.format), channels()));
    return *options_.format;
  }

  // One lobe is fitted to the source's own samples where it has some, else to pairs drawn from it.
  SampleSource sample_source(bool spread_phi_h) const {
    if (input_.samples) return from_samples(*input_.samples, options_.symmetrize);
    if (input_.table) return from_table(*input_.table, options_.symmetrize, spread_phi_h);
    const std::size_t count = options_.samples > 0      ? options_.samples
                              : input_.brdf.isotropic() ? kIsotropicSamples
                                                        : kAnisotropicSamples;
    return from_brdf(reference(), count, options_.seed, spread_phi_h);
  }

  TrainingSet training_set(bool spread_phi_h) const {
    if (input_.samples) return training_set_of(*input_.samples, options_.symmetrize);
    TrainingOptions drawn = training_for(0, 1, input_.brdf.isotropic());
    drawn.seed = options_.seed;
    drawn.spread_phi_h = spread_phi_h;
    return draw_training_set(reference(), drawn);
  }

  RefineOptions refine_options() const {
    RefineOptions options{.format = format()};
    if (options_.loss == FitLoss::relative) options.shares = {0, 0, 1, 0};
    if (options_.loss == FitLoss::log_cos) options.shares = {0, 0, 0.1, 1};
    if (options_.smooth) options.smooth = *options_.smooth;
    options.progress = progress("fitting");
    return options;
  }

  const FitInput& input_;
  const FitOptions& options_;
  std::optional<SymmetrizedBrdf> symmetrized_;
  Json notes_;
};

}  // namespace

Model fit(const FitInput& input, const FitOptions& options) {
  return Fitter(input, options).run();
}

}  // namespace burnish
