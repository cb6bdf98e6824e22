// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace burnish {

/// The transfer function of sRGB [IEC61966], of linear values in [0, 1], and back.
template <class T>
T srgb_encoded(T linear) noexcept {
  return linear <= T(0.0031308) ? T(12.92) * linear : T(1.055) * std::pow(linear, T(1 / 2.4)) - T(0.055);
}
template <class T>
T srgb_decoded(T encoded) noexcept {
  return encoded <= T(0.04045) ? encoded / T(12.92) : std::pow((encoded + T(0.055)) / T(1.055), T(2.4));
}

}  // namespace burnish
