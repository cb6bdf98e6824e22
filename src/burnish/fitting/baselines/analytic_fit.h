// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

#include <burnish/fitting/fit_summary.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

struct AnalyticFitOptions {
  std::size_t most_samples = 8000;                     ///< taken at most, evenly from all
  int max_iterations = 60;                             ///< from each start
  std::function<void(double fraction)> progress = {};  ///< called with rising shares of the work
};

struct AnalyticFit {
  AnalyticBrdf brdf;  ///< parameters rounded to single precision
  /// Errors are weighted rms ones of the cube roots: before at the best start, after of the result.
  /// Iterations are those of all starts, the reason is the best one's.
  FitSummary summary;
  int starts = 0;  ///< minimizations run
};

/// The models fit_analytic takes.
std::span<const std::string_view> fittable_models();

/// Fits an analytic model with a diffuse term by nonlinear least squares (Levenberg-Marquardt within the
/// parameters' ranges): the weighted squared differences of the cube roots of f sqrt(cos θ_i cos θ_o), the
/// metric that agreed best with viewers in [Fores 2012] in its reciprocal form, with the samples' weights.
/// Colours are one a channel, the roughness is shared, the same along and across for isotropic sources.
/// Starts from several roughnesses; lafortune adds its three lobes one after another, each from several
/// exponents. Deterministic. Throws Error for another model, a source of other than 1 or 3 channels, or one
/// without weight.
AnalyticFit fit_analytic(const SampleSource& source, std::string_view model,
                         const AnalyticFitOptions& options = {});

}  // namespace burnish
