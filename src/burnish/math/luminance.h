// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/math/rgb.h>

namespace burnish {

/// The shares of linear Rec. 709 red, green and blue in luminance, which sum to 1 [ITU 2015].
inline constexpr Rgb kLuminanceShares{0.2126, 0.7152, 0.0722};

/// Returns the luminance of a linear Rec. 709 colour, in its unit.
constexpr double luminance(Rgb f) noexcept {
  return kLuminanceShares.r * f.r + kLuminanceShares.g * f.g + kLuminanceShares.b * f.b;
}

}  // namespace burnish
