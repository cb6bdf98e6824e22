// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_spec.h>
#include <burnish/fitting/fit_summary.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

struct HomomorphicOptions {
  /// The fit minimizes the weighted mean over samples of the squared error in log f, plus smooth times the integrals
  /// over each table's unit interval or square of the squared second derivatives of log lambda. >= 0; larger is
  /// smoother; the same at every resolution.
  double smooth = 1e-8;
  /// The factors are fitted to log(max(f, 0) + floor), in (0, 1], 1/sr: what zeros and values that noise
  /// makes negative count as. Well below 1e-3, where the error figures stop to look.
  double floor = 3e-5;
  /// The largest number of passes of reweighted least squares after the first fit. They turn the mean square of the
  /// error in log f, which outliers and noise below error_floor dominate, into the mean absolute error of log(f +
  /// error_floor). The pass with the smallest error is kept. 0: the plain least-squares fit.
  int reweightings = 0;
  double error_floor = 1e-3;  ///< of the reweighted error, 1/sr, in (0, 1]
  /// Samples of smaller theta_d weigh (backscatter / theta_d)^1.5, down to theta_d of 1/64 of it. So samples spread
  /// evenly around wi = wo weigh the same for each step of sqrt(theta_d). Radians; 0: none does.
  double backscatter = 0;
  TableFormat format = TableFormat::half;  ///< of tables without one in the spec; see format_of
  int max_iterations = 300;                ///< of conjugate gradients
  double tolerance = 1e-3;  ///< conjugate gradients stop when the preconditioned residual fell to this share
  /// Called with rising shares of the work done, from the calling thread.
  std::function<void(double fraction)> progress;
};

struct HomomorphicFit {
  FactoredBrdf brdf;
  /// Errors are weighted rms of log f: before about its mean, the error of the best constant; after from log
  /// of the plain model, before reweighting and rounding. Iterations are of conjugate gradients, of all
  /// passes; the reason is the first pass's.
  FitSummary summary;
  std::size_t samples = 0;   ///< with weight
  std::size_t unknowns = 0;  ///< texels of all channels
  int reweightings = 0;      ///< passes used
};

/// Fits one lobe by homomorphic factorization: log f = sum of log lambda_k(pi_k) [HomomorphicBrdf, eq. 5] is one
/// linear row a sample and channel, with the (bi)linear weights of the texels it touches. The fit is weighted least
/// squares with a smoothness term, which also fills texels that no sample touches.
/// Small 1-D models are solved directly by normal equations gathered in one pass, others by matrix-free conjugate
/// gradients with a multilevel preconditioner. The result depends on neither the number of threads nor their timing.
/// Throws Error if the spec has no or several lobes, the options are out of range, or no sample has weight.
HomomorphicFit fit_homomorphic(const SampleSource& source, const ModelSpec& spec,
                               const HomomorphicOptions& options);

}  // namespace burnish
