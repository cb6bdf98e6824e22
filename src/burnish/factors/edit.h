#pragma once

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// What is changed in a model; the defaults change nothing, not a bit.
struct Edit {
  double hue = 0;        ///< radians by which the lobes' colours turn about grey; three channels only
  double roughness = 1;  ///< factor of tan(theta_h / 2) in tables over theta_h, in [0.1, 10]

  friend bool operator==(const Edit&, const Edit&) = default;
};

/// The model with the changes. Tables that the half vector alone, or theta_h along x, looks up are resampled
/// at their own nodes, linearly in the logarithm; beyond the horizon stands its value. A colour that turns
/// below zero becomes zero. Reciprocity stays. The highlight's peak stays as high when its width changes.
/// Throws Error if a number is not in its range.
FactoredBrdf edited(const FactoredBrdf& model, const Edit& edit);

}  // namespace burnish
