// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/metrics/measurement_quality.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/source.h>

namespace burnish::cli {

/// Describes the measured nodes alone, not the interpolation between them.
struct NodesInfo {
  const Source& source;  ///< must outlive it
  MeasuredNodes nodes;
  NodeFigures function;  ///< errors at the scored nodes of the source's own function, made reciprocal
  NodesQuality quality;
};

/// Throws Error where the source is a formula or model, or no node can be scored. `quality.held_out` is empty where
/// there are too few nodes for a prediction.
NodesInfo nodes_info(const Source& source);

/// Returns the text of `info --target nodes`.
std::string nodes_text(const NodesInfo& info);
/// Returns its JSON: name, format, channels, isotropic, count, theta_i_deg (where they are few), negative_share,
/// negative_rms, function, held_out and held_out_incidences (each count, log_cos, relative, rms_log, rms).
std::string nodes_json(const NodesInfo& info);

}  // namespace burnish::cli
