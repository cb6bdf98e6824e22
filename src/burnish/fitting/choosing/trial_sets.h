#pragma once

#include <cstddef>
#include <functional>

#include <burnish/fitting/refinement/refine.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// Every step-th pair, beginning at `first`.
TrainingSet part_of(const TrainingSet& set, std::size_t first, std::size_t step);

/// The set with one channel, the mean of its channels.
TrainingSet mean_of_channels(const TrainingSet& set);

/// An eighth of the pairs to fit trials to, and another to judge them on.
struct TrialSets {
  explicit TrialSets(const TrainingSet& set);

  TrainingSet fitted, judged;
};

/// The options of a trial: tables of floats and so many steps, without progress.
RefineOptions in_few_steps(RefineOptions options, int steps);

/// Calls work(k) of count trials, on all threads, and as they end the options' progress, from `from` to `to`, on the
/// calling thread.
void for_each_trial(std::size_t count, const RefineOptions& options, double from, double to,
                    const std::function<void(std::size_t)>& work);

}  // namespace burnish
