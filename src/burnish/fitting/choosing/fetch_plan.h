#pragma once

#include <vector>

#include <burnish/fitting/choosing/cost_limit.h>
#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Whether few bytes leave lobes of lines or hemispheres alone to serve: of an isotropic source where default_plan is
/// within the limit, of another always.
bool takes_lobes(BrdfRef source, const CostLimit& limit);
/// Whether the limit holds the tables of a model.
bool holds_model(BrdfRef source, const CostLimit& limit);
/// default_plan, of an anisotropic source with as many of its factors as the fetches allow.
LobePlan plan_within(BrdfRef source, const CostLimit& limit);

/// Models of 2, 3, 4, 6, 8, 12 and 24 fetches that the bytes hold, and lobes of lines where takes_lobes has them for as
/// many as they take, volumes with a line beside them: each fitted to part of the set, the mean of its channels, in few
/// steps and judged on another. By rising fetches; the limit's own do not count. Deterministic.
std::vector<FetchTrial> try_fetches(BrdfRef source, const TrainingSet& set, const CostLimit& limit,
                                    const RefineOptions& options);

/// How many pairs to draw for volumes, and where.
TrainingOptions training_for_volumes(const CostLimit& limit);

/// Fits the spec that serves best, of many nodes the first: each is fitted to part of the pairs in few steps
/// and judged on another part. The log-linear fit of its volume at fewer nodes is refined on part of the set,
/// then at all nodes on the whole. Throws Error as fit_homomorphic does.
LobesFit fit_volumes(const TrainingSet& set, const std::vector<ModelSpec>& specs,
                     const RefineOptions& options);

}  // namespace burnish
