// SPDX-License-Identifier: Apache-2.0
#include "info_json.h"

#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/shaders/cost_json.h>

namespace burnish::cli {

namespace {

constexpr std::size_t kFewIncidences = 100;
constexpr std::size_t kManyNodes = 20'000;  // predicting more nodes takes too long

}  // namespace

std::optional<NodesKnown> nodes_of(const Source& source) {
  if (!is_measurement(source)) return {};
  const auto [count, incidences] = count_nodes(source);
  NodesKnown known{.count = count, .incidences = {}, .predicted = {}};
  if (incidences <= kFewIncidences) known.incidences = incidences;
  if (source.ref().isotropic() && count > 1 && count <= kManyNodes) {
    try {
      known.predicted = held_out_figures(measured_nodes(source), LogCovariance(true));
    } catch (const Error&) {  // too few nodes, or all of them near grazing: no prediction
    }
  }
  return known;
}

std::string info_json(const SourceReport& report, const std::optional<NodesKnown>& nodes) {
  auto json = nlohmann::ordered_json::parse(to_json(report));
  if (nodes) {
    json["nodes"]["count"] = nodes->count;
    if (nodes->incidences) json["nodes"]["incident_angles"] = *nodes->incidences;
    if (nodes->predicted)
      json["nodes"]["predicted"] = {{"relative", nodes->predicted->relative},
                                    {"log_cos", nodes->predicted->log_cos}};
  }
  if (const auto cost = report.model ? shader_cost(*report.model) : std::nullopt)
    json["shader"] = cost_json(*cost);
  return json.dump(2);
}

}  // namespace burnish::cli
