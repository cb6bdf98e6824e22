// SPDX-License-Identifier: Apache-2.0
#pragma once

// A decoder of Neural Processes with weights of its own.

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <burnish/baselines/np_decoder.h>
#include <burnish/math/random.h>

namespace burnish {

/// Returns random weights of the decoder. Weights of a layer of n inputs lie within sqrt(6 / n) of 0, so that
/// values neither grow nor vanish; biases lie within 0.2. The last layer's are not negative and a tenth as
/// large, so that no output is cut off.
inline std::vector<float> random_np_weights(std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<float> weights;
  const auto draw = [&](std::size_t count, double range, bool last) {
    for (std::size_t i = 0; i < count; ++i)
      weights.push_back(
          static_cast<float>(last ? range * 0.1 * random.uniform() : range * (2 * random.uniform() - 1)));
  };
  for (std::size_t layer = 0; layer + 1 < NpDecoder::kUnits.size(); ++layer) {
    const std::size_t inputs = NpDecoder::kUnits[layer], outputs = NpDecoder::kUnits[layer + 1];
    const bool last = layer + 2 == NpDecoder::kUnits.size();
    draw(inputs * outputs, std::sqrt(6.0 / static_cast<double>(inputs)), last);
    draw(outputs, 0.2, last);
  }
  return weights;
}

inline std::shared_ptr<const NpDecoder> random_np_decoder(std::uint64_t seed) {
  return std::make_shared<const NpDecoder>(random_np_weights(seed));
}

}  // namespace burnish
