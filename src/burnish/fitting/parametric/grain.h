// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// The direction along which highlights are longest, degrees in [0, 180) from the tangent, counterclockwise: the second
/// harmonic about the normal of how much is reflected by half vectors that lean so (theta_h 10 to 40 degrees, theta_d
/// 15). 0 or 90 where it is within three degrees of them; 0 of what is isotropic, has hardly a direction or is not known
/// at two directions across each other.
double grain_direction(BrdfRef source);

}  // namespace burnish
