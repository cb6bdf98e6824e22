#include <burnish/fitting/cross_validation.h>

#include <algorithm>
#include <cmath>

#include <burnish/math/parallel.h>

namespace burnish {

namespace {

// The samples of a fold alone, or all others.
SampleSource part_of(const SampleSource& source, std::size_t folds, std::size_t fold, bool inside) {
  SampleSource part = source;
  part.fill = [&source, folds, fold, inside](std::size_t begin, std::span<DirectionPair> pairs,
                                             std::span<double> values, std::span<double> weights) {
    source.fill(begin, pairs, values, weights);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (((begin + i) % source.distinct % folds == fold) != inside) weights[i] = 0;
  };
  return part;
}

struct ErrorSum {
  double error = 0, weight = 0;
};

ErrorSum log_error(const SampleSource& source, const FactoredBrdf& model, double floor) {
  constexpr std::size_t kChunk = 4096;
  const auto channels = static_cast<std::size_t>(source.channels);
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

}  // namespace

double held_out_error(const SampleSource& source, const ModelSpec& spec, const HomomorphicOptions& options,
                      std::size_t folds) {
  ErrorSum sum;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    const FactoredBrdf model = fit_homomorphic(part_of(source, folds, fold, false), spec, options).brdf;
    const ErrorSum part = log_error(part_of(source, folds, fold, true), model, options.floor);
    sum.error += part.error;
    sum.weight += part.weight;
  }
  return sum.error / sum.weight;
}

std::vector<SmoothTrial> try_smoothness(const SampleSource& source, const ModelSpec& spec,
                                        const HomomorphicOptions& options) {
  constexpr std::size_t kManySamples = 20'000;
  constexpr int kFirstDecade = -10, kLastDecade = -1;
  const std::size_t folds = source.distinct > kManySamples ? 2 : 5;
  HomomorphicOptions trial_options = options;
  trial_options.progress = nullptr;
  std::vector<SmoothTrial> trials;
  const auto attempt = [&](double smooth) {
    trial_options.smooth = smooth;
    trials.push_back({smooth, held_out_error(source, spec, trial_options, folds)});
    constexpr double kTrials = kLastDecade - kFirstDecade + 3;
    if (options.progress) options.progress(static_cast<double>(trials.size()) / kTrials);
  };
  for (int decade = kFirstDecade; decade <= kLastDecade; ++decade) attempt(std::pow(10.0, decade));
  const double best = std::ranges::min(trials, {}, &SmoothTrial::error).smooth;
  attempt(best / std::sqrt(10.0));
  attempt(best * std::sqrt(10.0));
  std::ranges::stable_sort(trials, {}, &SmoothTrial::error);
  return trials;
}

}  // namespace burnish
