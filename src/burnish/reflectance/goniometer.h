// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// Both cosines of a drawn pair are above this.
inline constexpr double kDrawnCosine = 0.05;

/// `count` direction pairs drawn uniformly in (theta_h, theta_d, phi_d, phi_h) over
/// [0, pi/2]^2 x [0, 2 pi)^2, keeping those with both cosines above kDrawnCosine. phi_h is 0 where
/// `isotropic`. The same count, seed and flag give the same pairs; a smaller count gives a prefix.
std::vector<DirectionPair> draw_pairs(std::size_t count, std::uint64_t seed, bool isotropic);

/// Options of a virtual goniometer.
struct MeasureOptions {
  std::size_t count = 10000;
  double noise = 0;  ///< sigma of the logarithm of a factor on every value, >= 0; the factor's median is 1
  std::uint64_t seed = 1;
};

/// Samples of a source at pairs of draw_pairs, phi_h random for isotropic sources too; pairs where the source
/// knows nothing are left out and others drawn for them. Throws Error if the noise is no finite number >= 0,
/// or if fewer than one pair in a hundred is known.
Samples measure(BrdfRef source, const MeasureOptions& options);

}  // namespace burnish
