// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// By how much an isotropic BRDF differs from its mirror image in the plane of incidence: the mean over 4,000
/// random pairs of directions, and over channels, of half of |log((f + 0.001) / (f' + 0.001))|, f' that of
/// the mirrored pair. exp of it less 1 is the least relative error of a model that is its own mirror image. 0
/// where the source knows no pair.
double mirror_asymmetry(BrdfRef source);

/// From here on a fit tells mirror images apart: a tenth of a percent, below what instruments repeat.
inline constexpr double kMinAsymmetry = 0.001;

}  // namespace burnish
