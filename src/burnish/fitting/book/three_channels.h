// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <burnish/book/material_book.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// Grey values as three equal ones; others as they are.
inline TrainingSet in_three_channels(TrainingSet set) {
  if (set.channels != 1) return set;
  set.channels = MaterialBook::kChannels;
  std::vector<float> values;
  for (const float value : set.values) values.insert(values.end(), MaterialBook::kChannels, value);
  set.values = std::move(values);
  return set;
}

/// Returns true if a book can have a part in it: one channel or three.
constexpr bool book_takes(std::size_t channels) noexcept {
  return channels == 1 || channels == MaterialBook::kChannels;
}

}  // namespace burnish
