// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/fitting/one_lobe/homomorphic.h>

namespace burnish {

/// Held-out error of fit_homomorphic with these options, the weighted mean of |log((f + e) / (model + e))|
/// with e = options.error_floor: the samples are cut into `folds` by their number
/// modulo folds (both directions of a sample fall together), each fold is predicted by a fit to the others.
/// folds >= 2. Throws what fit_homomorphic throws.
double held_out_error(const SampleSource& source, const ModelSpec& spec, const HomomorphicOptions& options,
                      std::size_t folds);

/// Above this many samples choose_smoothness takes shortcuts.
inline constexpr std::size_t kManySamples = 20'000;

/// The trials of choose_smoothness.
struct SmoothTrial {
  double smooth = 0;
  std::vector<double> shares;  ///< smooth_share of each table
  double error = 0;            ///< held_out_error
};

/// Finds the smoothness with the smallest held_out_error. First it tries smooth = 10^k for falling k from -1 to -10,
/// until two decades in a row do not help. Then, for each table in turn, twice, it tries ever smaller or larger
/// shares by factors of ten as long as that helps; last, half a decade either way.
/// It uses five folds, or one a sample where there are fewer. For more than 20,000 samples, where little depends on
/// it, it uses two folds without reweighting, and all tables alike.
/// Returns all trials, the best first. options.progress is called with the share of the trials that are expected.
std::vector<SmoothTrial> choose_smoothness(const SampleSource& source, const ModelSpec& spec,
                                           const HomomorphicOptions& options);

}  // namespace burnish
