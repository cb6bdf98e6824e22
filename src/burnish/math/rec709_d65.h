// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace burnish {

/// The rows R, G, B of the matrix from X, Y, Z relative to D65 to linear Rec. 709. Source: [ITU 2015].
inline constexpr std::array<std::array<double, 3>, 3> kRec709OfD65 = {
    // clang-format off
    {{ 3.2404542, -1.5371385, -0.4985314},
     {-0.9692660,  1.8760108,  0.0415560},
     { 0.0556434, -0.2040259,  1.0572252}}
    // clang-format on
};

/// Returns linear Rec. 709 of X, Y, Z relative to D65. Saturated colours have values below zero.
constexpr std::array<double, 3> rec709_of_d65(const std::array<double, 3>& xyz) noexcept {
  std::array<double, 3> rgb{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) rgb[r] += kRec709OfD65[r][c] * xyz[c];
  return rgb;
}

}  // namespace burnish
