#pragma once

#include <cstddef>
#include <vector>

#include <burnish/fitting/choosing/cost_limit.h>
#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/tournament.h>

namespace burnish {

/// Anisotropic models of up to two fetches below the limit: one lobe or two of hemispheres q(h), and as the fetches
/// allow p(wo) p(wi) and tables of the difference, which tell directions about one half vector apart; where there is
/// room a line c(theta_d) for what is spread wide. Tables of the difference are volumes over theta_h, theta_d and
/// phi_d, which are their own mirror images, or over phi_s, which are not, or grids over theta_d and phi_s. What other
/// tables leave is q's. Forms whose tables the bytes do not hold are left out; throws Error if that leaves none.
std::vector<ModelSpec> hemisphere_specs(const CostLimit& limit, std::size_t channels);

/// Fits the spec that serves best. Each is fitted to part of the pairs, the mean of their channels, at about 900 nodes
/// in few steps, and judged on another part. Three finalists go on from there at all of their nodes, on a larger part; a
/// fetch more has to lower the errors. The winner goes on from there, channel by channel, on all pairs. A set with
/// albedos counts them in these last steps alone. Throws Error as fit_lobes does. Deterministic.
LobesFit fit_hemispheres(const TrainingSet& set, const std::vector<ModelSpec>& specs,
                         const RefineOptions& options);

/// The last steps of fit_hemispheres: the candidate's spec, channel by channel, from where the candidate stands, a model
/// of the mean of the channels.
LobesFit fit_hemispheres(const TrainingSet& set, const Candidate& start, const RefineOptions& options);

/// The three finalists of fit_hemispheres among models of any number of fetches, and these lobes, refined with
/// `of_lobes`: each fitted to a quarter of the pairs, the mean of their channels, and judged on another. Of two with as
/// many fetches the better one stays. Empty where the limit's bytes hold no hemispheres; its fetches do not count.
/// Deterministic.
FetchTrials try_hemispheres(const TrainingSet& set, CostLimit limit, const RefineOptions& options,
                            const LobePlan& lobes, const RefineOptions& of_lobes);

/// How many pairs to draw for them, and where.
TrainingOptions training_for_hemispheres();

}  // namespace burnish
