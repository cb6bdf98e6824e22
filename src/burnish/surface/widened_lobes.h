// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// The surface with copies of its lobes for mip levels: bumps that a level no longer shows make highlights wider, and a
/// copy is a lobe as bumps of some variance show it. A copy is the lobe times one more table over theta_h, so that all
/// other lookups are shared: the lobe's mean profile over half vectors, convolved with a normal distribution of slopes,
/// over itself. Each copy's peak is 0.18 of that of the one before, up to the largest variance of the normals; lobes
/// without a highlight get none, and lobes stay at most kMaxSurfaceLobes, the brightest peaks first. Level 0 stays as
/// it is: copies have weights in other levels alone (see WidenedLobe). Returns the surface as it is if it has no
/// normals or copies already. Deterministic.
SpatialBrdf with_widened_lobes(const SpatialBrdf& surface);

}  // namespace burnish
