// SPDX-License-Identifier: Apache-2.0
#include "nodes_info.h"

#include <iterator>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/written_degrees.h>
#include <burnish/metrics/figures_json.h>

namespace burnish::cli {

namespace {

constexpr std::size_t kListedIncidences = 24;

std::vector<double> incidences_deg(const MeasuredNodes& nodes) {
  std::vector<double> list;
  for (const double theta_i : nodes.theta_i) list.push_back(written_degrees(theta_i));
  return list;
}

}  // namespace

NodesInfo nodes_info(const Source& source) {
  NodesInfo info{.source = source, .nodes = measured_nodes(source), .function = {}, .quality = {}};
  info.function = node_figures(info.nodes, SymmetrizedBrdf(source.ref()));
  try {
    info.quality = nodes_quality(info.nodes);
  } catch (const Error&) {  // too few nodes, or all of them near grazing: no prediction
    info.quality = negatives_of(info.nodes);
  }
  return info;
}

std::string nodes_text(const NodesInfo& info) {
  const auto& [source, nodes, function, quality] = info;
  std::string text;
  const auto line = [&](std::string_view what, const std::string& says) {
    fmt::format_to(std::back_inserter(text), "{:<13}{}\n", what, says);
  };
  const auto errors = [](const NodeFigures& f) {
    return fmt::format("relative {:.4f}, rms_log {:.4f}, log_cos {:.4f}, rms {:.4g} 1/sr", f.relative,
                       f.rms_log, f.log_cos, f.rms);
  };
  // These lines describe the nodes.
  line("name", source.name);
  line("format", source.findings.format);
  line("channels", fmt::format("{}", nodes.samples.channels));
  line("material", nodes.samples.isotropic ? "isotropic" : "anisotropic");
  line("nodes", fmt::format("{}, {} of them with both cosines above {}", nodes.size(), function.count,
                            NodeScoring{}.least_cosine));
  if (nodes.theta_i.size() <= kListedIncidences)
    line("theta_i", fmt::format("{:.1f} degrees", fmt::join(incidences_deg(nodes), " ")));
  else
    line("theta_i", fmt::format("{} angles", nodes.theta_i.size()));
  line("negatives", fmt::format("{:.2f} % of the values{}", 100 * quality.negative_share,
                                quality.negative_share > 0
                                    ? fmt::format(", root mean square {:.3g} 1/sr", quality.negative_rms)
                                    : ""));
  // These lines say how well each node is predicted.
  line("function", "errors at the nodes, made reciprocal: " + errors(function));
  if (quality.held_out)
    line("unseen", "errors of the function between the other nodes: " + errors(*quality.held_out));
  if (quality.held_out_incidences)
    line("unseen",
         "errors of a whole theta_i, predicted by the others: " + errors(*quality.held_out_incidences));
  return text;
}

std::string nodes_json(const NodesInfo& info) {
  const auto& [source, nodes, function, quality] = info;
  const auto figures = [](const NodeFigures& f) {
    return json_of(f, {"log_cos", "relative", "rms_log", "rms"});
  };
  nlohmann::ordered_json json{{"name", source.name},
                              {"format", source.findings.format},
                              {"channels", nodes.samples.channels},
                              {"isotropic", nodes.samples.isotropic},
                              {"count", nodes.size()}};
  if (nodes.theta_i.size() <= kListedIncidences) json["theta_i_deg"] = incidences_deg(nodes);
  json["negative_share"] = quality.negative_share;
  json["negative_rms"] = quality.negative_rms;
  json["function"] = figures(function);
  if (quality.held_out) json["held_out"] = figures(*quality.held_out);
  if (quality.held_out_incidences) json["held_out_incidences"] = figures(*quality.held_out_incidences);
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace burnish::cli
