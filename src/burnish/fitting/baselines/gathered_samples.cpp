// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <burnish/error.h>
#include <burnish/fitting/baselines/compressive_weight.h>
#include <burnish/fitting/baselines/gathered_samples.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {

GatheredSamples gather_samples(const SampleSource& source, std::size_t most) {
  GatheredSamples result{.channels = source.channels};
  const double step = std::max(1.0, static_cast<double>(source.count) / static_cast<double>(most));
  DirectionPair pair;
  std::vector<double> values(result.channels);
  double weight = 0;
  // one at a time: those between are not made
  for (double next = 0; next < static_cast<double>(source.count); next += step) {
    source.fill(static_cast<std::size_t>(next), {&pair, 1}, values, {&weight, 1});
    if (!(weight > 0) || std::min(pair.wi.z, pair.wo.z) <= kDrawnCosine) continue;
    result.pairs.push_back(pair);
    result.weights.push_back(weight);
    for (const double value : values) result.values.push_back(std::max(0.0, value));
  }
  if (result.pairs.empty()) throw Error("expected a sample with a weight above 0, found none");
  return result;
}

std::vector<double> compressive_weights(const GatheredSamples& samples, std::size_t channel) {
  std::vector<double> weights(samples.size());
  double sum = 0, total = 0;
  const auto square = [&](std::size_t i) { return samples.pairs[i].wi.z * samples.pairs[i].wo.z; };
  const auto value = [&](std::size_t i) {
    return std::sqrt(square(i)) * samples.values[i * samples.channels + channel];
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sum += samples.weights[i] * value(i);
    total += samples.weights[i];
  }
  const double mean = std::max(sum / total, std::numeric_limits<double>::min());
  for (std::size_t i = 0; i < samples.size(); ++i)
    weights[i] = samples.weights[i] * square(i) * compressive_weight(value(i), mean);
  return weights;
}

}  // namespace burnish
