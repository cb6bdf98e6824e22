// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <burnish/fitting/choosing/budget_ladder.h>
#include <burnish/metrics/measurement_quality.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

namespace {

ErrorLevel level_of(const ErrorFigures& figures) {
  return {.relative = figures.relative, .log_cos = figures.log_cos, .rms = figures.rms, .psnr = figures.psnr};
}
ErrorLevel level_of(const NodeFigures& figures) {
  return {.relative = figures.relative, .log_cos = figures.log_cos, .rms = figures.rms, .psnr = {}};
}

// The ratio of an error to the noise, 0 if one of them is not known.
double ratio(std::optional<double> error, std::optional<double> noise) {
  return error && noise && *noise > 0 ? *error / *noise : 0;
}

}  // namespace

NoiseScale::NoiseScale(const Source& source, BrdfRef fitted, bool symmetrized, const FigureOptions& figures) {
  scorer_.emplace(fitted, figures);
  if (!symmetrized || !is_measurement(source)) return;
  if (const auto exchanged = exchanged_figures(*scorer_, source.ref())) noise_ = level_of(*exchanged);
  if (!fitted.isotropic()) return;
  const double unseen = held_out_figures(measured_nodes(source), LogCovariance(true)).relative;
  if (!noise_) noise_.emplace(ErrorLevel{.relative = unseen, .log_cos = {}, .rms = {}, .psnr = {}});
  noise_->relative = std::min(noise_->relative, unseen);
}

NoiseScale::NoiseScale(const MeasuredNodes& nodes, const std::optional<NodeFigures>& held_out)
    : nodes_(nodes) {
  if (held_out) noise_ = level_of(*held_out);
}

ErrorLevel NoiseScale::error_of(BrdfRef model) const {
  return nodes_ ? level_of(node_figures(*nodes_, model)) : level_of(scorer_->score(model));
}

double NoiseScale::excess(const ErrorLevel& error) const noexcept {
  if (!noise_) return error.relative / kMinRelative;
  const double picture = error.psnr && noise_->psnr ? std::pow(10, (*noise_->psnr - *error.psnr) / 20) : 0;
  return std::max({error.relative / std::max(noise_->relative, kMinRelative),
                   ratio(error.log_cos, noise_->log_cos), ratio(error.rms, noise_->rms), picture});
}

std::optional<BudgetStop> stop_after(std::span<const BudgetTrial> trials, bool noise_known) {
  const BudgetTrial& last = trials.back();
  if (last.excess <= 1) return noise_known ? BudgetStop::noise : BudgetStop::floor;
  if (trials.size() > 1) {
    const BudgetTrial& before = trials[trials.size() - 2];
    const double doublings = std::log2(static_cast<double>(last.bytes) / static_cast<double>(before.bytes));
    const double enough = std::pow(1 - kMinBudgetGain, doublings);
    if (last.excess > before.excess * enough && last.error.relative > before.error.relative * enough)
      return BudgetStop::gain;
  }
  if (last.bytes >= kBudgetLadder.back()) return BudgetStop::largest;
  return {};
}

}  // namespace burnish
