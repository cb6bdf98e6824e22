// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/log_covariance.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/reflectance/pair_error.h>

namespace burnish {

/// The errors of a model at the measured nodes: weighted means over them and the channels, each as in ErrorFigures.
struct NodeFigures {
  double log_cos = 0, relative = 0, rms_log = 0, rms = 0;
  std::size_t count = 0;  ///< nodes that were scored
};

/// Which nodes are scored and how; the defaults are the definition.
struct NodeScoring {
  double least_cosine = 0.15;  ///< of both directions: beyond it instruments err more than models
  double floor = 1e-3;         ///< 1/sr, as in FigureOptions
};

/// Errors at the scored nodes that the model knows, in their order; values below 0 count as 0.
/// Throws Error if the channel counts do not fit.
std::vector<PairError> node_errors(const MeasuredNodes& nodes, BrdfRef model,
                                   const NodeScoring& scoring = {});

/// Throws Error as node_errors, or where no node is left to score.
NodeFigures node_figures(const MeasuredNodes& nodes, BrdfRef model, const NodeScoring& scoring = {});

/// Figures of KrigedNodes at nodes that it was not made from (cross-validation): groups are dealt to `folds` folds,
/// and each fold is predicted from the others. Where there are many nodes, a part of them is scored, the same for
/// every covariance. folds >= 2. Throws Error as KrigedNodes and node_figures.
NodeFigures held_out_figures(const MeasuredNodes& nodes, const LogCovariance& covariance, int folds = 4);

/// The same with incidences left out, all nodes of one together, two or more apart; the first and the last never are.
/// Nothing where there are fewer than five incidences, or so many that each is only a few nodes, or no node can be scored.
std::optional<NodeFigures> held_out_incidences(const MeasuredNodes& nodes, const LogCovariance& covariance);

/// Returns the one of the default and the likely covariances that predicts best. It has the least sum of the
/// logarithms of relative and log_cos, of held_out_figures and, where there is such, of held_out_incidences. Returns
/// the default where no node can be scored. `progress` is told rising shares. Deterministic.
LogCovariance choose_covariance(const MeasuredNodes& nodes,
                                const std::function<void(double fraction)>& progress = {});

}  // namespace burnish
