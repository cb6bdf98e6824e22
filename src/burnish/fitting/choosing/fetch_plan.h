// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/fitting/choosing/cost_limit.h>
#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// True if the bytes are so few that lobes of lines or hemispheres serve best. For an isotropic source, default_plan
/// also has to be within the limit.
bool takes_lobes(BrdfRef source, const CostLimit& limit);
/// True if the limit holds the tables of a model.
bool holds_model(BrdfRef source, const CostLimit& limit);
/// Returns default_plan. For an anisotropic source it keeps as many factors as the fetches allow.
LobePlan plan_within(BrdfRef source, const CostLimit& limit);

/// Tries models with different numbers of fetches: those of 2, 3, 4, 6, 8, 12 and 24 fetches that the bytes hold. If
/// takes_lobes holds with the number of fetches that lobes of lines need, these lobes are tried too. Volumes have a
/// line beside them. Each model is fitted in few steps to part of the set, as the mean of its channels, and judged on
/// another part. Returns the trials by rising fetches. The limit's own fetches do not count. Deterministic.
std::vector<FetchTrial> try_fetches(BrdfRef source, const TrainingSet& set, const CostLimit& limit,
                                    const RefineOptions& options);

/// Returns the number and distribution of pairs to draw for volumes.
TrainingOptions training_for_volumes(const CostLimit& limit);

/// Fits the spec that serves best. Each spec is fitted to part of the pairs in few steps and judged on another part;
/// of specs with many nodes the first is taken untried. The log-linear fit of its volume at fewer nodes is refined on
/// part of the set, then at all nodes on the whole set. Throws Error as fit_homomorphic does.
LobesFit fit_volumes(const TrainingSet& set, const std::vector<ModelSpec>& specs,
                     const RefineOptions& options);

}  // namespace burnish
