// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/analytic/microfacet_distribution.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/sampling.h>

namespace burnish {

/// Draws directions for a material as if it were GGX: with probability `share` the mirror of wo about a visible
/// normal of the distribution, otherwise in proportion to the cosine. Directions below the horizon are lost. Source:
/// [Heitz 2018], drawn by the spherical cap [Dupuy 2023].
struct GgxProxy {
  GgxDistribution distribution;
  double share = 1;

  DrawnDirection sample_wi(Vec3 wo, Point2 u) const noexcept;
  double pdf(Vec3 wi, Vec3 wo) const noexcept;
};

static_assert(DirectionSampler<GgxProxy>);

/// The proxy whose weights f cos / pdf have the least relative second moment under uniform light, the mean
/// over eight polar angles of wo up to 84 degrees. alpha in [0.004, 1] to 2 %, one alpha for both axes
/// (two where the BRDF is anisotropic); `share` is 1 unless `with_cosine`, then a multiple of 0.05 up to
/// 0.95.
GgxProxy fit_ggx_proxy(BrdfRef brdf, bool with_cosine);

}  // namespace burnish
