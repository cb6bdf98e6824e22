// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// The three lit spheres (metrics/sphere_images.h) of a BRDF, at few places that crowd at the highlights: a
/// quadrature of the pictures' squared error.
struct PicturePairs {
  std::vector<DirectionPair> pairs;  ///< lit and seen
  std::vector<double> weights;       ///< shares of the three frames' area
  std::vector<double> values;        ///< f, 1/sr, three a pair
  std::vector<double> shown;         ///< (exposure f cos theta_i)^(1/2.2), not clamped; three a pair
  double exposure = 1;

  /// Returns true if all channels are equal.
  bool grey() const noexcept;

  /// (exposure f cos theta_i)^(1/2.2) of another BRDF of three channels.
  std::vector<double> shown_of(BrdfRef brdf) const;

  /// Mean squared difference of min(1, dim * shown) from what another BRDF shows.
  double mean_squared_error(std::span<const double> other, double dim = 1) const noexcept;
};

/// Places of a source of 1 or 3 channels that it knows. For isotropic sources they cover half of each sphere.
/// `exposure` as sphere_exposure.
PicturePairs picture_pairs(BrdfRef source, double exposure);

}  // namespace burnish
