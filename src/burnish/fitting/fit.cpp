// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/baselines/negative_lobes.h>
#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/fitting/energy.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/fit_budget.h>
#include <burnish/fitting/fit_one.h>
#include <burnish/fitting/fit_several.h>
#include <burnish/fitting/fitted_model.h>
#include <burnish/fitting/fitted_source.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

namespace {

constexpr std::size_t kBaselineSamples = 200'000, kBookSamples = 1000;  // drawn from a function
// Fewer samples of an anisotropic source than this make one lobe.
constexpr std::size_t kFewAnisotropic = 1000;

Error no_model() {
  return Error("fit: expected a product of tables, found a baseline");
}

BrdfRef ref_of(const FactoredBrdf& brdf) noexcept {
  return brdf;
}
BrdfRef ref_of(const BaselineBrdf& brdf) noexcept {
  return baseline_ref(brdf);
}

/// Fits each form. Everything that it refers to outlives it.
struct FormFitter {
  const FittedSource& source;
  const FitOptions& options;
  const Stages& stages;

  FittedModel operator()(const Budget& form) const { return fit_budget(source, options, form, stages); }
  FittedModel operator()(const DefaultBudget& form) const {
    return fit_budget(source, options, form, stages);
  }

  FittedModel operator()(const OneLobe& form) const {
    ModelSpec spec = parse_model_spec(form.model, form.tables, source.isotropic());
    if (spec.lobes.size() != 1)
      throw Error(
          fmt::format("fit: expected a model of one lobe, found {} in '{}'", spec.lobes.size(), form.model));
    FittedLobe fitted = fit_one(source, options, std::move(spec), form.how, stages);
    return {.brdf = std::move(fitted.brdf), .how = std::move(fitted.report)};
  }

  FittedModel operator()(const GivenLobes& form) const {
    FittedLobes fitted = fit_given(source, options, form, stages);
    return {.brdf = std::move(fitted.brdf), .how = std::move(fitted.report)};
  }

  FittedModel operator()(const BaselineMethod& form) const {
    if (options.format || options.smooth || options.conserve_energy)
      throw Error(
          fmt::format("fit: expected no format, smoothness or energy conservation with method {}, found one",
                      form.method));
    if (form.bytes == std::uint64_t{0}) throw Error("fit: expected at least one byte for a method, found 0");
    const SampleSource samples = source.sample_source(kBaselineSamples, false);
    BaselineOptions how{.seed = options.seed, .progress = stages.of(form.method)};
    if (form.bytes) how.budget = *form.bytes;
    BaselineFit fit = fit_baseline(source.reference(), samples, form.method, how);
    return {.brdf = std::move(fit.brdf),
            .how = BaselineReport{.method = std::move(fit.method),
                                  .budget = how.budget,
                                  .layouts_tried = fit.layouts_tried,
                                  .summary = fit.summary,
                                  .starts = fit.starts,
                                  .negative_lobes = {}}};
  }

  FittedModel operator()(const FromBook& form) const {
    if (options.smooth || source.nodes())
      throw Error(
          "fit: expected no smoothness and function as the target with a book, found a smoothness or nodes");
    const TableFormat format = source.format();
    const Samples* const samples = source.samples();
    Completion completion =
        samples ? complete(*form.book, *samples, format)
                : complete(*form.book,
                           measure(source.reference(),
                                   {.count = options.samples.value_or(kBookSamples), .seed = options.seed}),
                           format);
    return {.brdf = std::move(completion.brdf), .how = std::move(completion.report)};
  }
};

/// Scales the model where it reflects too much, and reports the change of its errors.
EnergyReport conserve(const FittedSource& source, FactoredBrdf& brdf) {
  EnergyConservation kept = conserve_energy(brdf);
  const Scorer scorer(source.reference(), source.held_out());
  EnergyReport report{.largest_albedo_before = std::ranges::max(kept.largest_before),
                      .largest_albedo_after = std::ranges::max(kept.largest_after),
                      .iterations = kept.iterations,
                      .before = scorer.score(brdf),
                      .after = scorer.score(kept.brdf)};
  brdf = std::move(kept.brdf);
  return report;
}

/// Reports the errors of the stored model at the nodes that are the target.
void score_nodes(const FittedSource& source, const FitOptions& options, const Fit& fit, NodesReport& report) {
  const BrdfRef brdf = std::visit([](const auto& any) { return ref_of(any); }, fit.brdf);
  report.at_fitted = node_figures(*source.nodes(), brdf);
  if (options.hold_out)
    report.at_held_out = node_figures(nodes_of(measured_nodes(source.source()), *options.hold_out), brdf);
  if (source.between() && brdf.channels() == source.between()->channels())
    report.expected = expected_error(*source.between(), brdf);
}

/// Scores the stored model on pairs that were not fitted.
void score(const FittedSource& source, const FitOptions& options, Fit& fit) {
  if (fit.report.nodes) score_nodes(source, options, fit, *fit.report.nodes);
  if (const auto* baseline = std::get_if<BaselineBrdf>(&fit.brdf)) {
    const Scorer scorer(source.reference(), source.held_out_of_baselines());
    fit.report.held_out = scorer.score(baseline_ref(*baseline));
    auto& report = std::get<BaselineReport>(fit.report.how);
    if (report.method == "svd")
      report.negative_lobes = negative_lobes(std::get<SeparableBrdf>(*baseline), scorer);
  } else if (!source.samples()) {
    fit.report.held_out =
        error_figures(source.reference(), std::get<FactoredBrdf>(fit.brdf), source.held_out());
  }
}

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

  // A fit to scattered samples is better than one to a function made of them. There are two exceptions. Peaks about
  // wi = wo need a lobe of their own, and few anisotropic samples leave the tables of several lobes undetermined.
  // Options for one lobe also ask for a fit of one lobe to the function.
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

Fit fit(const Source& source, const FitOptions& asked) {
  FitOptions options = asked;
  // Light that goes the other way through a surface comes from its other side, which is another source.
  options.symmetrize = asked.symmetrize && !source.findings.transmits();
  const Stages stages(options);
  const FittedSource fitted(source, options, stages);
  const auto start = std::chrono::steady_clock::now();
  FittedModel model = std::visit(FormFitter{fitted, options, stages}, options.form.value_or(DefaultBudget{}));
  Fit result{
      .brdf = std::move(model.brdf),
      .lambda_nm = source.findings.lambda_nm,
      .report = {.source = source.name,
                 .source_format = source.findings.format,
                 .block = source.findings.block,
                 .symmetrized = options.symmetrize,
                 .how = std::move(model.how),
                 .budget_choice = std::move(model.budget_choice),
                 .nodes = fitted.nodes_report(),
                 .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()}};
  if (options.conserve_energy) result.report.energy = conserve(fitted, std::get<FactoredBrdf>(result.brdf));
  if (options.score) score(fitted, options, result);
  return result;
}

}  // namespace burnish
