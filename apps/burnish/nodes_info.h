#pragma once

#include <string>

#include <burnish/metrics/measurement_quality.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/source.h>

namespace burnish::cli {

/// What was measured says, and nothing of what is between.
struct NodesInfo {
  const Source& source;  ///< must outlive it
  MeasuredNodes nodes;
  NodeFigures function;  ///< the owner's, made reciprocal, at the nodes that are scored
  NodesQuality quality;
};

/// Throws Error where the source is a formula or model, or no node can be scored; where there are too few to foretell one
/// another, held_out is none.
NodesInfo nodes_info(const Source& source);

/// For people: `info --target nodes`.
std::string nodes_text(const NodesInfo& info);
/// With --json: name, format, channels, isotropic, count, theta_i_deg (where they are few), negative_share, negative_rms,
/// function, held_out and held_out_incidences (each count, log_cos, relative, rms_log, rms).
std::string nodes_json(const NodesInfo& info);

}  // namespace burnish::cli
