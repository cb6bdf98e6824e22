// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include <burnish/fitting/fit_summary.h>
#include <burnish/fitting/parametric/picture_pairs.h>
#include <burnish/reflectance/analytic/openpbr.h>

namespace burnish {

struct OpenPbrFit {
  OpenPbrParameters parameters;  ///< rounded to six decimals
  /// Errors are rms ones of the pictures: before of the best first start, after of the result. Iterations are those of
  /// all minimizations.
  FitSummary summary;
  int starts = 0;  ///< minimizations run
};

struct OpenPbrFitOptions {
  bool grey = false;         ///< colours are grey, and there is no film, which has some
  bool anisotropic = false;  ///< stretches are looked for
  bool simple = false;       ///< base and specular alone, without coat, fuzz and film
  double tangent = 0;        ///< geometry_tangent, which stays: grain_direction of the source
  std::function<void(double fraction)> progress = {};
};

/// The OpenPBR material whose lit spheres have the least mean squared difference from those of `pairs`, pictures at
/// 1/32 of the exposure adding a little, so that highlights keep their height: Levenberg-Marquardt steps within the
/// ranges of kOpenPbrInputs, of roughnesses from .02, of indices to 3, of a coat's from 1.05, of the fuzz's colour from
/// .1, of films to 1.5 micrometres. Smooth to rough
/// metals and dielectrics are tried first, then the best with coats, fuzz and films, and 240 random starts, on a
/// twelfth and then a third of the pixels; the best of each kind go on, and films once more on the best of all. A film,
/// a fuzz or a coat without which the squared error is less than half a decibel greater is left out. Other inputs
/// without which it is less than a percent greater go back to their defaults, so that of inputs that say the same one
/// is left; base_weight is 1. The same bits for every number of threads.
OpenPbrFit fit_openpbr(const PicturePairs& pairs, const OpenPbrFitOptions& options = {});

/// Fits from random starts, as a yardstick for fit_openpbr: returns the best of `count` >= 1 starts anywhere in the
/// same ranges, with every input varied. The best is the one whose pictures differ least.
/// Hopeless starts are given up. On a third of the pixels, each start has 15 iterations, and the better quarter 20
/// more. The better twentieth of all goes, on all pixels, to where refine_openpbr ends. error_before is the least of
/// these last beginnings. Seed 1 begins with the random starts of fit_openpbr.
OpenPbrFit fit_openpbr_at_random(const PicturePairs& pairs, int count, std::uint64_t seed,
                                 const OpenPbrFitOptions& options = {});

/// One minimization over all inputs from given ones.
OpenPbrFit refine_openpbr(const PicturePairs& pairs, const OpenPbrParameters& start,
                          const OpenPbrFitOptions& options = {});

}  // namespace burnish
