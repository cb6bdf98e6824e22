// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/fitting/choosing/cost_limit.h>
#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/tournament.h>

namespace burnish {

/// Returns anisotropic models of up to two fetches below the limit. They have one or two lobes of hemispheres q(h).
/// As the fetches allow, they also have p(wo) p(wi) and tables of the difference, which separate directions about one
/// half vector. If there is room, they have a line c(theta_d) for what is spread wide.
///
/// A table of the difference is one of three. A volume over theta_h, theta_d and phi_d is its own mirror image; one
/// over phi_s is not; the third is a grid over theta_d and phi_s. q takes the texels that the other tables leave.
/// Forms whose tables the bytes do not hold are left out. Throws Error if no form is left.
std::vector<ModelSpec> hemisphere_specs(const CostLimit& limit, std::size_t channels);

/// Fits the spec that serves best. Each spec is fitted to part of the pairs, as the mean of their channels, at about
/// 900 nodes in few steps, and judged on another part. Three finalists continue at all of their nodes on a larger
/// part; each further fetch has to lower the errors. The winner continues on all pairs, channel by channel. Albedos
/// of a set count in these last steps only. Throws Error as fit_lobes does. Deterministic.
LobesFit fit_hemispheres(const TrainingSet& set, const std::vector<ModelSpec>& specs,
                         const RefineOptions& options);

/// Runs the last steps of fit_hemispheres. They start from the candidate's fit, a model of the mean of the channels,
/// and refine its spec channel by channel.
LobesFit fit_hemispheres(const TrainingSet& set, const Candidate& start, const RefineOptions& options);

/// Compares the three finalists of fit_hemispheres, among models of any number of fetches, with `lobes`, refined with
/// `of_lobes`. Each is fitted to a quarter of the pairs, as the mean of their channels, and judged on another
/// quarter. The better of two with equal fetches stays. Empty if the limit's bytes hold no hemispheres; its fetches
/// do not count. Deterministic.
FetchTrials try_hemispheres(const TrainingSet& set, CostLimit limit, const RefineOptions& options,
                            const LobePlan& lobes, const RefineOptions& of_lobes);

/// Returns the number and distribution of pairs to draw for hemispheres.
TrainingOptions training_for_hemispheres();

}  // namespace burnish
