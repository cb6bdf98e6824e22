// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include <burnish/baselines/dgf_brdf.h>
#include <burnish/fitting/fit_summary.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

struct DgfOptions {
  std::size_t budget = 2640;  ///< bytes; half of the nodes go to D, a quarter each to G and F
  int rounds = 100;           ///< of alternation over D, F, G and the diffuse constants
  /// Samples taken at most, evenly from all.
  std::size_t most_samples = 60'000;
  std::function<void(double fraction)> progress = {};  ///< called with rising shares of the work
};

struct DgfFit {
  DgfBrdf brdf;
  /// Errors are weighted squared ones, means over the channels: before of the first guess, after of the
  /// result before rounding. Stops after all rounds.
  FitSummary summary;
};

/// Fits the microfacet factors by alternating weighted least squares, every value >= 0: each table enters the
/// model linearly while the others stand still, G with one of its two uses held. Weights as
/// compressive_weights makes them; F and G are kept smooth. D has at most 180 nodes, F and G at most 90, the
/// counts of the paper's measured tables. Deterministic. Throws Error if the source is anisotropic, no sample
/// has weight, or the budget leaves fewer than 4 nodes for a table. Source: [Bagher 2016].
DgfFit fit_dgf(const SampleSource& samples, const DgfOptions& options);

}  // namespace burnish
