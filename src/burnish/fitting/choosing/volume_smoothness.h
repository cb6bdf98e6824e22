// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/factors/model_spec.h>
#include <burnish/reflectance/measured_nodes.h>

namespace burnish {

/// Chooses the smoothness of a model with a volume: RefineOptions::smooth, for shares that add up to about four. Each
/// half of the nodes is predicted from the other half. The best smoothness has the least sum of the logarithms of
/// relative and log_cos (node_figures), in steps of ten from 1e-9 to 1e-4. It is then divided by a factor, because
/// half of the nodes are farther apart than all of them. If there are many nodes, a part of them is used. Structure
/// between nodes, for example the speckle of a normalization, has no effect: it cancels at the nodes. Deterministic.
/// Throws Error if one half has no nodes, and as fit_volumes does.
double choose_volume_smoothness(const MeasuredNodes& nodes, const ModelSpec& spec, bool symmetrize);

}  // namespace burnish
