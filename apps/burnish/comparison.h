#pragma once

#include <optional>
#include <string>

#include <burnish/report/compare_report.h>
#include <burnish/source.h>

namespace burnish::cli {

/// An opened BRDF, made reciprocal like the others unless it is so by construction or transmits. Refers to the source,
/// which must outlive it.
class Candidate {
 public:
  Candidate(const Source& source, bool symmetrize);
  Candidate(const Candidate&) = delete;

  BrdfRef ref() const;
  const Source& source() const { return source_; }
  /// Nothing where the source is none.
  const FactoredBrdf* model() const { return std::get_if<FactoredBrdf>(&source_.brdf); }
  /// What is scored, under that name; refers to this object.
  ComparedModel compared(const std::string& name) const;

 private:
  const Source& source_;
  std::optional<SymmetrizedBrdf> symmetrized_;
};

/// What is known of a reference that is a measurement, of part of its nodes if `only` says which (parse_node_part);
/// nothing of a formula or model unless nodes are asked for, which then throws Error.
std::optional<Measurement> measurement_of(const Candidate& reference, bool nodes_asked,
                                          const std::string& only);

}  // namespace burnish::cli
