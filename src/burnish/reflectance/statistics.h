#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// The share of light from one direction that is reflected.
struct DirectionalAlbedo {
  std::vector<double> albedo;  ///< one a channel; unknown directions count as black
  double unknown_fraction =
      0;  ///< share of the projected hemisphere where the source knows nothing, in [0, 1]
};

/// The integral of f(wi, wo) cos(theta_o) over the hemisphere of wo. Midpoint rule over 256 angles r from and
/// 128 azimuths around the mirror direction, r spaced as a square so that narrow peaks are met: within 0.002
/// for a Lambertian surface and for cosine lobes up to exponent 1000.
DirectionalAlbedo directional_albedo(BrdfRef source, Vec3 wi);

/// How far a source is from reciprocal.
struct ReciprocityError {
  double mean = 0;  ///< mean of 2 |f(wi, wo) - f(wo, wi)| / (f(wi, wo) + f(wo, wi)) over pairs and channels
  std::size_t pairs = 0;  ///< pairs known both ways
};

/// Over `count` pairs of draw_pairs; channels whose two values are both 0 count as reciprocal.
ReciprocityError reciprocity_error(BrdfRef source, std::size_t count, std::uint64_t seed);

}  // namespace burnish
