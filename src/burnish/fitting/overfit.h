#pragma once

#include <burnish/fitting/budget.h>

namespace burnish {

/// Whether a fit has so few pairs of directions a texel, and so much more error on pairs that it did not see,
/// that a smoother one may be better.
bool is_overfit(const LobesFit& fit, const TrainingSet& set, const TrainingSet& held_out,
                const ErrorTerms& shares);

/// Fits the plan with ten times the smoothness, and again while the objective on the pairs that are not
/// fitted falls. Leaves the best fit and its smoothness, perhaps those given.
void fit_smoother(const TrainingSet& set, const TrainingSet& held_out, const LobePlan& plan,
                  std::size_t bytes, std::size_t texel_bytes, RefineOptions& options, LobesFit& fit);

}  // namespace burnish
