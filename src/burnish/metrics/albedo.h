// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// The share of light from one direction that is reflected.
struct DirectionalAlbedo {
  std::vector<double> albedo;   ///< one a channel; unknown directions count as black
  std::vector<double> clamped;  ///< the same with values below zero cut: what their noise adds is light
  double unknown_fraction =
      0;  ///< share of the projected hemisphere where the source knows nothing, in [0, 1]
};

inline constexpr double kAlbedoTolerance = 0.005;

/// The integral of f(wi, wo) cos(theta_o) over the hemisphere of wo, wi above the horizon; of raw values (see
/// BrdfRef::unclamped), whose noise cancels. Midpoint rule over
/// rings around the mirror direction, their radii spaced as squares so that narrow peaks are met, each ring
/// cut exactly at the horizon. The number of rings (and that of points on a ring, half as many) doubles from
/// 64 until no channel changes by more than `tolerance` of itself or of the channels' mean, whichever is larger, up to
/// 512. Within `tolerance` of the integral for Lambertian surfaces, cosine lobes up to exponent 10^5 and GGX down to
/// alpha 0.02, up to 85 degrees; peaks away from the mirror direction that fall between the first rings go unseen.
DirectionalAlbedo directional_albedo(BrdfRef source, Vec3 wi, double tolerance = kAlbedoTolerance);

/// The albedo of light from one direction, in radians.
struct AlbedoAt {
  double theta_i = 0, phi_i = 0;
  DirectionalAlbedo albedo;
};

/// At every theta_i in [0, pi/2), phi_i 0, and pi/2 too unless the source is isotropic.
std::vector<AlbedoAt> albedo_curve(BrdfRef source, std::span<const double> theta_i);

}  // namespace burnish
