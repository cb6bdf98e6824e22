// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Error of one direction pair, means over the channels.
struct PairError {
  DirectionPair pair;
  double log_cos = 0;         ///< as in ErrorFigures
  double log_ratio = 0;       ///< |ln((f + floor) / (f^ + floor))|
  double log_ratio_sq = 0;    ///< its square's mean
  double difference_sq = 0;   ///< mean (f - f^)^2, 1/sr^2
  double abs_log = 0;         ///< |ln(f / f^)| over the channels where both are above 0
  int positive_channels = 0;  ///< how many those are
};

/// Error of a model's values at one pair, floor >= 0. One channel stands for every channel of the other side.
PairError pair_error(const DirectionPair& pair, std::span<const double> reference,
                     std::span<const double> model, double floor) noexcept;

}  // namespace burnish
