// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <burnish/report/compare_report.h>
#include <burnish/source.h>

namespace burnish::cli {

/// An opened BRDF, made reciprocal if `symmetrize` is set. It stays as it is where it transmits or is reciprocal by
/// construction. Refers to the source, which must outlive it.
class Candidate {
 public:
  Candidate(const Source& source, bool symmetrize);
  Candidate(const Candidate&) = delete;

  BrdfRef ref() const;
  const Source& source() const { return source_; }
  /// Returns the factored model, or null where the source is none.
  const FactoredBrdf* model() const { return std::get_if<FactoredBrdf>(&source_.brdf); }
  /// Returns the model to score, under that name; it refers to this object.
  ComparedModel compared(const std::string& name) const;

 private:
  const Source& source_;
  std::optional<SymmetrizedBrdf> symmetrized_;
};

/// Returns the measurement behind a reference, or nothing for a formula or model. `only` chooses a part of its nodes
/// (parse_node_part). Throws Error where `nodes_asked` and the reference is no measurement.
std::optional<Measurement> measurement_of(const Candidate& reference, bool nodes_asked,
                                          const std::string& only);

}  // namespace burnish::cli
