// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A direction above the horizon and the solid angle it stands for, sr.
struct DirectionWeight {
  Vec3 wi;
  double weight = 0;
};

/// A rule for integrals over wi of what a BRDF reflects towards wo: half vectors on `azimuths` equally spaced
/// rays, on each `radii` of them with tan^2(theta_h / 2) in equal ratios from 1e-9 of the largest at which wi
/// stays above the horizon, so that narrow lobes and wide ones are both resolved. Relative error for the
/// cosine: 0.2 % with 64 x 256 points. wo.z > 0, azimuths and radii >= 1.
std::vector<DirectionWeight> half_vector_quadrature(Vec3 wo, int azimuths, int radii);

/// Size over the channels of the light reflected from wi towards wo: the root of the mean square of f cos
/// theta_i, which is what a density has to follow for the least sum of the channels' variances. `scratch` has
/// channels() entries.
double reflected_size(BrdfRef brdf, Vec3 wi, Vec3 wo, std::span<double> scratch) noexcept;

}  // namespace burnish
