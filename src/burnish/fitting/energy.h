// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// The directions in which albedos are computed, and their precision.
struct EnergyOptions {
  int theta_count = 48;  ///< polar angles of wi from the normal to kMaxTheta, denser towards grazing; >= 2
  int phi_count = 24;    ///< azimuths around, of anisotropic models; >= 1
  double tolerance = 0.005;  ///< of an albedo, see directional_albedo
  int max_iterations = 12;
};

struct EnergyConservation {
  FactoredBrdf brdf;
  std::vector<double> largest_before, largest_after;  ///< largest albedo, one a channel
  int iterations = 0;                                 ///< of the gain
};

/// Makes the directional albedo of every channel at most 1 + tolerance, for wi from the normal to 89.5 degrees, with
/// little change. A gain g <= 1 over directions multiplies the table that a lobe looks up by wi and by wo, so
/// reciprocal models stay reciprocal. It is below 1 only where the albedo then is 1,
///     g(wi) (integral of f(wi, wo) g(wo) cos(theta_o)) = 1,
/// found by a symmetric Sinkhorn iteration [SinkhornKnopp1967]. Lobes without such a table are scaled as a
/// whole if they exceed 1 by themselves; and all lobes are, by what rounding to the tables' formats, their
/// resolution and the last steps of the iteration leave above 1. Tables of one channel take the smallest gain
/// of any. A model that conserves energy on the grid comes back as it is. Throws Error if an option is out of
/// range.
EnergyConservation conserve_energy(const FactoredBrdf& brdf, const EnergyOptions& options = {});

}  // namespace burnish
