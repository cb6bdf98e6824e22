// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/refinement/refine.h>

namespace burnish {

struct LobesFit {
  LogModel model;
  /// The summary of the last refinement, with the errors of refine. Its iterations are the Gauss-Newton steps of all
  /// refinements and channels.
  FitSummary summary;
};

/// Fits an isotropic plan. The first lobe is fitted log-linearly [HomomorphicBrdf, eq. 5]. Then one lobe after
/// another is split off and refined; each split starts from the present function. A plan with a wide lobe is fitted
/// by fit_lobes.
///
/// The angles of the first splits decide where refinement ends, within a few percent of the errors. So `starts`
/// different ways, at least 1, are tried on part of the data, and the one with the least objective continues on all
/// of it. Several starts are used only for plans of few unknowns, whose steps are solved directly. Rounding to the
/// table format is left to to_brdf. Throws Error as plan_to_spec and fit_homomorphic do.
LobesFit fit_plan(const TrainingSet& set, const LobePlan& plan, std::size_t bytes, std::size_t texel_bytes,
                  const RefineOptions& options, std::size_t starts = 1);
/// The number of starts of fits.
inline constexpr std::size_t kLobeStarts = 4;

/// Fits a given model of any number of lobes. Each lobe starts as the log-linear fit to its part of the data. Parts
/// are cut along theta_d, or by height if the lobes differ in shape. Then all lobes are refined together.
LobesFit fit_lobes(const TrainingSet& set, const ModelSpec& spec, const RefineOptions& options);

}  // namespace burnish
