#pragma once

#include <cstddef>

#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/refinement/refine.h>

namespace burnish {

struct LobesFit {
  LogModel model;
  /// Of the last refinement, its errors as refine says; iterations are the Gauss-Newton steps of all
  /// refinements and channels.
  FitSummary summary;
};

/// Fits an isotropic plan: one lobe log-linearly [HomomorphicBrdf, eq. 5], then one split off after the other
/// and refined, each split starting from the function there was. A plan with a wide lobe is fitted by
/// fit_lobes. Which angles lobes are split at first decides where refinement ends, within a few percent of the
/// errors: of `starts` ways, at least 1, that with the least objective on part of the data goes on to all of it. They
/// serve plans of few unknowns, whose steps are solved directly; others have one. Rounding to the table format is left
/// to to_brdf. Throws Error as plan_to_spec and fit_homomorphic do.
LobesFit fit_plan(const TrainingSet& set, const LobePlan& plan, std::size_t bytes, std::size_t texel_bytes,
                  const RefineOptions& options, std::size_t starts = 1);
/// The starts that fits take.
inline constexpr std::size_t kLobeStarts = 4;

/// Fits a given model of any number of lobes: each starts as the log-linear fit to its part of the data,
/// parts cut along theta_d, or by height where the lobes differ in shape; then all are refined together.
LobesFit fit_lobes(const TrainingSet& set, const ModelSpec& spec, const RefineOptions& options);

}  // namespace burnish
