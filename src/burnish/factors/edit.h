// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// Changes to a model. The defaults change no bit.
struct Edit {
  std::vector<double>
      hue;  ///< radians by which colours turn about grey, of all lobes or of each; three channels only
  double roughness = 1;  ///< factor of tan(theta_h / 2) in tables over theta_h, in [0.1, 10]

  friend bool operator==(const Edit&, const Edit&) = default;
};

/// The model with the changes.
/// - A lobe's colour is what it reflects of light from within 60 degrees of the normal: the mean of its directional
///   albedos, one a channel, good to 1 %. Beyond, where fits are seldom held by measurements, tables say little of it.
///   Turned, its mean over the channels stays, and it becomes paler where a channel would fall below 0 or rise above 1
///   (above the largest before, where that is more). The lobe's scales change by as much as its colour, so that neither
///   their size nor how tables are normalized plays a part. Light from one direction changes by the same factors.
/// - Tables that the half vector alone, or theta_h along x, looks up are resampled at their own nodes, linearly in the
///   logarithm; beyond the horizon stands its value. The highlight's peak stays as high when its width changes.
/// Reciprocity stays. Throws Error if a number is not in its range or the hues are neither one nor one a lobe.
FactoredBrdf edited(const FactoredBrdf& model, const Edit& edit);

}  // namespace burnish
