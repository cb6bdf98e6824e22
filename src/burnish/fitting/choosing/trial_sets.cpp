#include <atomic>
#include <thread>

#include <burnish/fitting/choosing/trial_sets.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::size_t kTrialPart = 8;

}  // namespace

TrainingSet part_of(const TrainingSet& set, std::size_t first, std::size_t step) {
  TrainingSet shifted = set;
  // drop the first pairs of both kinds, so that thinning begins elsewhere
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

TrialSets::TrialSets(const TrainingSet& set)
    : fitted(part_of(set, 0, kTrialPart)), judged(part_of(set, kTrialPart / 2, kTrialPart)) {}

RefineOptions in_few_steps(RefineOptions options, int steps) {
  options.format = TableFormat::single;
  options.max_iterations = steps;
  options.progress = nullptr;
  return options;
}

void for_each_trial(std::size_t count, const RefineOptions& options, double from, double to,
                    const std::function<void(std::size_t)>& work) {
  const std::function<void(double)> progress = part_of_progress(options.progress, from, to);
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
