// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <burnish/io/source_report.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish::cli {

/// The measured nodes of a source.
struct NodesKnown {
  std::size_t count;
  std::optional<std::size_t> incidences;  ///< their number, where they are few
  std::optional<NodeFigures>
      predicted;  ///< each node predicted from the others: the score of the measurement itself
};

/// Returns nothing for a formula or model.
std::optional<NodesKnown> nodes_of(const Source& source);

/// Returns the text of `info --json`: the report, the nodes of a measurement, and the cost of a model's shader.
std::string info_json(const SourceReport& report, const std::optional<NodesKnown>& nodes);

}  // namespace burnish::cli
