// SPDX-License-Identifier: Apache-2.0
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
  return {.name = name,
          .brdf = ref(),
          .bytes = source_.bytes(),
          .note = source_.findings.description,
          .factored = model()};
}

std::optional<Measurement> measurement_of(const Candidate& reference, bool nodes_asked,
                                          const std::string& only) {
  return burnish::measurement_of(reference.source(), reference.ref(), nodes_asked, only);
}

}  // namespace burnish::cli
