#pragma once

#include <cstddef>
#include <vector>

#include <burnish/fitting/homomorphic.h>

namespace burnish {

/// A smoothness and what it costs on samples that the fit did not see.
struct SmoothTrial {
  double smooth = 0;
  double error = 0;  ///< weighted mean of |log((f + floor) / (model + floor))|
};

/// Held-out error of fit_homomorphic with these options: the samples are cut into `folds` by their number modulo folds
/// (both directions of a sample fall together), each fold is predicted by a fit to the others. folds >= 2.
/// Throws what fit_homomorphic throws.
double held_out_error(const SampleSource& source, const ModelSpec& spec, const HomomorphicOptions& options,
                      std::size_t folds);

/// Tries smooth = 10^k for k from -10 to -1, then half decades beside the best, by held_out_error with five folds (two
/// for more than 20,000 samples), and returns all trials, the best first.
std::vector<SmoothTrial> try_smoothness(const SampleSource& source, const ModelSpec& spec,
                                        const HomomorphicOptions& options);

}  // namespace burnish
