// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <thread>
#include <utility>

#include <burnish/factors/fetches.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/math/parallel.h>

namespace burnish {

TrainingSet part_of(const TrainingSet& set, std::size_t first, std::size_t step) {
  TrainingSet shifted = set;
  // The first pairs of both kinds are dropped, so that thinning begins elsewhere.
  const auto channels = static_cast<std::ptrdiff_t>(set.channels);
  const auto drop = [&](std::size_t at) {
    const auto n = static_cast<std::ptrdiff_t>(at), m = static_cast<std::ptrdiff_t>(first);
    shifted.pairs.erase(shifted.pairs.begin() + n, shifted.pairs.begin() + n + m);
    shifted.weights.erase(shifted.weights.begin() + n, shifted.weights.begin() + n + m);
    shifted.values.erase(shifted.values.begin() + n * channels, shifted.values.begin() + (n + m) * channels);
  };
  if (set.size() - set.picture_count > first) drop(set.picture_count);
  if (set.picture_count > first) {
    drop(0);
    shifted.picture_count -= first;
  }
  return thinned(shifted, step);
}

TrainingSet mean_of_channels(const TrainingSet& set) {
  TrainingSet grey = set;
  grey.channels = 1;
  const auto channels = set.channels;
  grey.values.resize(set.size());
  grey.albedo = {};
  for (std::size_t i = 0; i < set.size(); ++i) {
    double sum = 0;
    for (std::size_t c = 0; c < channels; ++c) sum += set.values[i * channels + c];
    grey.values[i] = static_cast<float>(sum / static_cast<double>(channels));
  }
  return grey;
}

TrialParts::TrialParts(const TrainingSet& set, std::size_t step)
    : fitted(part_of(set, 0, step)), judged(part_of(set, step / 2, step)) {}

double Heat::error_of(const LogModel& fit) const {
  return objective(fit, parts.judged, shares);
}

void Heat::play(std::span<Candidate> candidates, const std::function<void(Candidate&)>& fit,
                const std::function<void(double)>& progress) const {
  for_each_trial(candidates.size(), progress, [&](std::size_t k) {
    Candidate& candidate = candidates[k];
    fit(candidate);
    candidate.error = error_of(candidate.fit);
    if (worth_of_fetch > 0)
      candidate.error += worth_of_fetch * shares.sum() * static_cast<double>(fetch_count(candidate.spec));
  });
}

std::vector<Candidate> finalists(std::vector<Candidate> candidates, std::size_t count) {
  std::ranges::stable_sort(candidates, {}, &Candidate::error);
  candidates.resize(std::min(count, candidates.size()));
  return candidates;
}

Candidate& winner(std::span<Candidate> candidates) {
  return *std::ranges::min_element(candidates, {}, &Candidate::error);
}

FetchTrial fetch_trial_of(const Candidate& candidate, const ErrorTerms& shares) {
  return {.fetches = static_cast<int>(fetch_count(candidate.spec)),
          .lobes = candidate.plan.has_value(),
          .error = std::exp(candidate.error / shares.sum())};
}

FetchTrials best_of_each_fetch_count(std::vector<Candidate> candidates, const ErrorTerms& shares) {
  std::vector<FetchTrial> trials;
  for (const Candidate& candidate : candidates) trials.push_back(fetch_trial_of(candidate, shares));
  std::vector<std::size_t> order(trials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t k) { return std::pair(trials[k].fetches, trials[k].error); });
  FetchTrials best;
  for (const std::size_t k : order) {
    if (!best.trials.empty() && best.trials.back().fetches == trials[k].fetches) continue;
    best.trials.push_back(trials[k]);
    best.candidates.push_back(std::move(candidates[k]));
  }
  return best;
}

const FetchTrial& trial_at_knee(std::span<const FetchTrial> trials) {
  const double least = std::ranges::min(trials, {}, &FetchTrial::error).error;
  return *std::ranges::find_if(trials,
                               [&](const FetchTrial& trial) { return trial.error <= kKneeFactor * least; });
}

RefineOptions in_few_steps(RefineOptions options, int steps) {
  options.format = TableFormat::single;
  options.max_iterations = steps;
  options.progress = nullptr;
  return options;
}

void for_each_trial(std::size_t count, const std::function<void(double)>& progress,
                    const std::function<void(std::size_t)>& work) {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> done = 0;
  for_each_chunk(count, 1, [&](std::size_t k, std::size_t, std::size_t) {
    work(k);
    const std::size_t ended = ++done;
    if (progress && std::this_thread::get_id() == caller)
      progress(static_cast<double>(ended) / static_cast<double>(count));
  });
}

}  // namespace burnish
