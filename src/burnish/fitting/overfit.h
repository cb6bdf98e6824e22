#pragma once

#include <cstdint>

#include <burnish/fitting/budget.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Whether a fit has so few pairs of directions a texel, and so much more error on pairs that it did not see,
/// that a smoother one may be better.
bool is_overfit(const LobesFit& fit, const TrainingSet& set, const TrainingSet& held_out,
                const ErrorTerms& shares);

/// Fits the plan with ten times the smoothness, and again while the objective on the pairs that are not
/// fitted falls. Leaves the best fit and its smoothness, perhaps those given.
void fit_smoother(const TrainingSet& set, const TrainingSet& held_out, const LobePlan& plan,
                  std::size_t bytes, std::size_t texel_bytes, RefineOptions& options, LobesFit& fit);

/// fit_plan, and where the fit is_overfit to pairs drawn from the source anew, fit_smoother.
LobesFit fit_without_overfit(BrdfRef source, const TrainingSet& set, const LobePlan& plan, std::size_t bytes,
                             std::size_t texel_bytes, std::uint64_t seed, RefineOptions& options);

}  // namespace burnish
