#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <burnish/io/source_report.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish::cli {

/// What is known of the places that were measured.
struct NodesKnown {
  std::size_t count;
  std::optional<std::size_t> incidences;  ///< where they are few
  std::optional<NodeFigures>
      predicted;  ///< each by the others: what the measurement itself would score there
};

/// Nothing of a formula or model.
std::optional<NodesKnown> nodes_of(const Source& source);

/// What `info --json` prints: the report, with the nodes of a measurement, and of a model with what its shader costs.
std::string info_json(const SourceReport& report, const std::optional<NodesKnown>& nodes);

}  // namespace burnish::cli
