// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// Samples with weight, in memory.
struct GatheredSamples {
  std::size_t channels = 0;
  std::vector<DirectionPair> pairs;
  std::vector<double> values;   ///< [sample][channel], 1/sr, >= 0
  std::vector<double> weights;  ///< > 0

  std::size_t size() const noexcept { return pairs.size(); }
};

/// At most `most` samples of a source, evenly from all, without those that have no weight or a cosine of at
/// most kDrawnCosine. Throws Error if none is left.
GatheredSamples gather_samples(const SampleSource& source, std::size_t most);

/// Weights of squared errors of f: sample weight * cos θ_i cos θ_o * compressive_weight of
/// f sqrt(cos θ_i cos θ_o).
std::vector<double> compressive_weights(const GatheredSamples& samples, std::size_t channel);

}  // namespace burnish
