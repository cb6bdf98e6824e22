// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <burnish/fitting/fit_one.h>
#include <burnish/fitting/fit_several.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/refinement/rounding.h>

namespace burnish {

namespace {

// The numbers of steps that count albedos, and the share of albedos in the loss.
constexpr int kAlbedoSteps = 20, kLongAlbedoSteps = 6;
constexpr double kAlbedoShare = 0.3;

/// Runs last steps that count albedos too. Earlier, albedos would mislead lobes that are not fitted yet.
void reflect_as_much(const FittedSource& source, LogModel& model, TrainingSet& set, RefineOptions& refine,
                     const Stages& stages) {
  add_albedos(source, set, refine);
  RefineOptions steps = refine;
  const bool direct = coupled_unknowns(model.spec, source.channels()) <= kMaxCholeskyUnknowns;
  steps.max_iterations = direct ? kAlbedoSteps : kLongAlbedoSteps;
  steps.progress = stages.of("matching albedos");
  burnish::refine(model, set, steps);
}

}  // namespace

RefineOptions refine_options(const FittedSource& source, const FitOptions& options, FitLoss loss,
                             const Stages& stages) {
  RefineOptions refine{.format = source.format()};
  if (loss == FitLoss::relative) refine.shares = {.relative = 1};
  if (loss == FitLoss::log_cos) refine.shares = {.relative = 0.1, .log_cos = 1};
  if (options.smooth) refine.smooth = *options.smooth;
  refine.progress = stages.of("fitting");
  return refine;
}

bool counts_albedos(const FittedSource& source, FitLoss loss) {
  return !source.samples() && loss == FitLoss::image;
}

void add_albedos(const FittedSource& source, TrainingSet& set, RefineOptions& refine) {
  set.albedo = albedo_set(source.reference());
  refine.shares.albedo = kAlbedoShare;
}

FittedLobes finish(const FittedSource& source, LobesFit fit, TrainingSet set, RefineOptions refine,
                   LobesReport report, const Stages& stages) {
  if (counts_albedos(source, report.loss)) reflect_as_much(source, fit.model, set, refine, stages);
  return rounded(fit, set, refine, std::move(report));
}

FittedLobes rounded(const LobesFit& fit, const TrainingSet& set, const RefineOptions& refine,
                    LobesReport report) {
  report.summary = fit.summary;
  report.samples = set.size();
  report.lobes = fit.model.spec.lobes.size();
  return {.brdf = to_rounded_brdf(fit.model, set, refine), .report = std::move(report)};
}

FittedLobes fit_given(const FittedSource& source, const FitOptions& options, const GivenLobes& form,
                      const Stages& stages) {
  const ModelSpec spec = parse_model_spec(form.model, form.tables, source.isotropic());
  const TrainingSet set = source.training_set(has_disk(spec));
  const RefineOptions refine = refine_options(source, options, form.loss, stages);
  return finish(source, fit_lobes(set, spec, refine), set, refine, {.loss = form.loss}, stages);
}

}  // namespace burnish
