#pragma once

#include <cstddef>

#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// Every step-th pair, beginning at `first`.
TrainingSet part_of(const TrainingSet& set, std::size_t first, std::size_t step);

/// The set with one channel, the mean of its channels.
TrainingSet mean_of_channels(const TrainingSet& set);

}  // namespace burnish
