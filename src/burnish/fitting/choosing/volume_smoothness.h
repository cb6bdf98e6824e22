#pragma once

#include <burnish/factors/model_spec.h>
#include <burnish/reflectance/measured_nodes.h>

namespace burnish {

/// The smoothness (RefineOptions::smooth, for shares that add up to about four) with which a model that has a volume
/// predicts one half of the nodes best from the other, both ways: the least sum of the logarithms of relative and
/// log_cos (node_figures), by steps of ten from 1e-9 to 1e-4, softened by what half of the nodes stand farther apart
/// than all. Of many nodes a part is taken. What only the function between nodes holds, such as the speckle of a
/// normalization, plays no part: it cancels at the nodes. Deterministic. Throws Error where one half has no nodes, and
/// as fit_volumes does.
double choose_volume_smoothness(const MeasuredNodes& nodes, const ModelSpec& spec, bool symmetrize);

}  // namespace burnish
