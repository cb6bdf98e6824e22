// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/fitting/choosing/between_incidences.h>
#include <burnish/fitting/choosing/scattered_plan.h>
#include <burnish/fitting/fit_one.h>
#include <burnish/fitting/one_lobe/cross_validation.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/fitting/one_lobe/log_error.h>

namespace burnish {

namespace {

// Scattered samples are few and noisy: they are fitted robustly, with the smoothness that predicts best.
constexpr int kScatteredReweightings = 4;
// The tolerance for samples of different weights, whose conjugate gradients take longer.
constexpr double kBackscatterTolerance = 2e-4;
constexpr double kExpectedWeight = 0.01;  // for a sample of between_incidences
constexpr std::size_t kExpectedFolds = 5;

// Pairs drawn for one lobe from a source that is a function; an anisotropic one has one dimension more.
constexpr std::size_t kIsotropicSamples = 200'000, kAnisotropicSamples = 500'000;

HomomorphicOptions log_linear_options(const FittedSource& source, const LogLinear& how,
                                      const Stages& stages) {
  HomomorphicOptions options;
  options.floor = how.floor;
  options.reweightings = how.reweightings.value_or(source.samples() ? kScatteredReweightings : 0);
  options.progress = stages.of("fitting");
  return options;
}

/// Fits a lobe to `fitted`, which begins with the samples of `measured`.
FittedLobe finish_one(const FittedSource& source, const SampleSource& measured, const SampleSource& fitted,
                      const ModelSpec& spec, const HomomorphicOptions& options, OneLobeReport report) {
  HomomorphicFit result = fit_homomorphic(fitted, spec, options);
  report.summary = result.summary;
  report.samples = result.samples - (fitted.count - measured.count);
  report.smooth = options.smooth;
  report.floor = options.floor;
  report.reweightings = result.reweightings;
  for (const ModelSpec::TableSpec& table : spec.tables)
    if (table.smooth_share != 1) report.smooth_shares.emplace_back(table.name, table.smooth_share);
  if (source.samples())
    report.relative = std::expm1(log_error(measured, result.brdf, options.error_floor).mean());
  return {.brdf = std::move(result.brdf), .report = std::move(report)};
}

/// Returns values between incidences that a first fit predicts; none for sources that do not backscatter.
Samples expected_of(const SampleSource& source, const ModelSpec& spec, const HomomorphicOptions& options) {
  if (options.backscatter <= 0 || !source.isotropic) return {};
  return between_incidences(source, fit_homomorphic(source, spec, options).brdf);
}

}  // namespace

FittedLobe fit_one(const FittedSource& source, const FitOptions& options, ModelSpec spec,
                   const LogLinear& how, const Stages& stages) {
  const SampleSource samples = source.sample_source(
      source.isotropic() ? kIsotropicSamples : kAnisotropicSamples, has_disk(spec), source.table());
  HomomorphicOptions log_linear = log_linear_options(source, how, stages);
  if (options.format) log_linear.format = *options.format;
  OneLobeReport report;

  // The smoothness is given, or the one that predicts best.
  if (options.smooth) {
    log_linear.smooth = *options.smooth;
  } else if (how.cross_validate || source.samples()) {
    const std::vector<SmoothTrial> trials = choose_smoothness(samples, spec, log_linear);
    log_linear.smooth = trials.front().smooth;
    for (std::size_t t = 0; t < spec.tables.size(); ++t)
      spec.tables[t].smooth_share = trials.front().shares[t];
    if (samples.distinct <= kManySamples) report.relative_cross_validated = std::expm1(trials.front().error);
  }
  return finish_one(source, samples, samples, spec, log_linear, std::move(report));
}

FittedLobe fit_scattered(const FittedSource& source, const FitOptions& options, const LogLinear& how,
                         std::uint64_t bytes, std::optional<int> fetches, const Stages& stages) {
  // The lobe is reciprocal, so exchanged samples would add no information.
  const SampleSource samples = from_samples(*source.samples(), false);
  if (options.format) source.check_format(*options.format);
  HomomorphicOptions log_linear = log_linear_options(source, how, stages);
  if (backscatters(samples)) {
    log_linear.backscatter = kBackscatterReach;
    log_linear.tolerance = kBackscatterTolerance;
  }
  const ScatteredPlan plan =
      plan_scattered(samples, bytes, options.smooth, options.format, log_linear, fetches.value_or(0));
  log_linear.smooth = plan.smooth;
  log_linear.format = plan.format;
  OneLobeReport report;
  if (plan.error && !options.smooth) report.relative_cross_validated = std::expm1(*plan.error);

  // The values that a first fit predicts between incidences are added to the samples with little weight.
  const Samples expected = expected_of(samples, plan.spec, log_linear);
  if (expected.size() == 0)
    return finish_one(source, samples, samples, plan.spec, log_linear, std::move(report));
  const SampleSource both = with_expected(samples, expected, kExpectedWeight);
  if (report.relative_cross_validated)  // samples of so little weight do not affect it
    report.relative_cross_validated = std::expm1(held_out_error(both, plan.spec, log_linear, kExpectedFolds));
  return finish_one(source, samples, both, plan.spec, log_linear, std::move(report));
}

bool has_disk(const ModelSpec& spec) {
  return std::ranges::any_of(spec.tables,
                             [](const auto& table) { return table.layout.shape == TableShape::disk; });
}

}  // namespace burnish
