#include "comparison.h"

namespace burnish::cli {

Candidate::Candidate(const Source& source, bool symmetrize) : source_(source) {
  if (symmetrize && !source.findings.transmits() && !(model() && model()->reciprocal()))
    symmetrized_.emplace(source_.ref());
}

BrdfRef Candidate::ref() const {
  return symmetrized_ ? BrdfRef(*symmetrized_) : source_.ref();
}

ComparedModel Candidate::compared(const std::string& name) const {
  return {.name = name, .brdf = ref(), .bytes = source_.bytes(), .note = source_.findings.description};
}

std::optional<Measurement> measurement_of(const Candidate& reference, bool nodes_asked,
                                          const std::string& only) {
  if (!nodes_asked && only.empty() && !is_measurement(reference.source())) return {};
  Measurement measurement{.nodes = measured_nodes(reference.source()), .itself = {}, .quality = {}};
  if (!only.empty()) measurement.nodes = nodes_of(measurement.nodes, parse_node_part(only));
  measurement.itself = node_figures(measurement.nodes, reference.ref());
  if (const auto* scattered = std::get_if<ScatteredBrdf>(&reference.source().brdf))
    measurement.between = scattered->kriged();
  if (measurement.between) measurement.expected = expected_error(*measurement.between, reference.ref());
  return measurement;
}

}  // namespace burnish::cli
