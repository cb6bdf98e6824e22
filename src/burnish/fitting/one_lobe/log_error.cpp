// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <burnish/fitting/one_lobe/log_error.h>
#include <burnish/math/parallel.h>

namespace burnish {

ErrorSum log_error(const SampleSource& source, const FactoredBrdf& model, double floor) {
  constexpr std::size_t kChunk = 4096;
  const auto channels = source.channels;
  std::vector<ErrorSum> parts(chunk_count(source.count, kChunk));
  for_each_chunk(source.count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    std::vector<DirectionPair> pairs(n);
    std::vector<double> values(n * channels), weights(n), f(channels);
    source.fill(begin, pairs, values, weights);
    for (std::size_t i = 0; i < n; ++i) {
      if (!(weights[i] > 0) || pairs[i].wi.z <= 0 || pairs[i].wo.z <= 0) continue;
      model.eval(pairs[i].wi, pairs[i].wo, f);
      for (std::size_t c = 0; c < channels; ++c) {
        const double target = std::max(values[i * channels + c], 0.0);
        parts[chunk].error += weights[i] * std::abs(std::log((target + floor) / (f[c] + floor)));
        parts[chunk].weight += weights[i];
      }
    }
  });
  ErrorSum sum;
  for (const ErrorSum& part : parts) {
    sum.error += part.error;
    sum.weight += part.weight;
  }
  return sum;
}

}  // namespace burnish
