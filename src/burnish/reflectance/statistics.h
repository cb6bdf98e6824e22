// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// The error of a source's reciprocity.
struct ReciprocityError {
  double mean = 0;  ///< mean of 2 |f(wi, wo) - f(wo, wi)| / (f(wi, wo) + f(wo, wi)) over pairs and channels
  std::size_t pairs = 0;  ///< pairs known both ways
};

/// Over `count` pairs of draw_pairs; channels whose two values are both 0 count as reciprocal.
ReciprocityError reciprocity_error(BrdfRef source, std::size_t count, std::uint64_t seed);

}  // namespace burnish
