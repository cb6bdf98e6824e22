#include <algorithm>
#include <cmath>
#include <limits>

#include <burnish/error.h>
#include <burnish/fitting/baselines/compressive_weight.h>
#include <burnish/fitting/baselines/gathered_samples.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {

GatheredSamples gather_samples(const SampleSource& source, std::size_t most) {
  GatheredSamples result{.channels = static_cast<std::size_t>(source.channels)};
  constexpr std::size_t kBlock = 4096;
  const double step = std::max(1.0, static_cast<double>(source.count) / static_cast<double>(most));
  std::vector<DirectionPair> pairs(kBlock);
  std::vector<double> values(kBlock * result.channels), weights(kBlock);
  double next = 0;  // number of the next sample that is taken
  for (std::size_t begin = 0; begin < source.count; begin += kBlock) {
    const std::size_t count = std::min(kBlock, source.count - begin);
    source.fill(begin, std::span(pairs).first(count), std::span(values).first(count * result.channels),
                std::span(weights).first(count));
    for (; next < static_cast<double>(begin + count); next += step) {
      const std::size_t i = static_cast<std::size_t>(next) - begin;
      if (!(weights[i] > 0) || std::min(pairs[i].wi.z, pairs[i].wo.z) <= kDrawnCosine) continue;
      result.pairs.push_back(pairs[i]);
      result.weights.push_back(weights[i]);
      for (std::size_t c = 0; c < result.channels; ++c)
        result.values.push_back(std::max(0.0, values[i * result.channels + c]));
    }
  }
  if (result.pairs.empty()) throw Error("expected a sample with weight, found none");
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
