// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace burnish {

/// A colour or a coefficient for each of the channels, linear Rec. 709.
struct Rgb {
  double r = 0, g = 0, b = 0;

  constexpr Rgb() = default;
  constexpr Rgb(double red, double green, double blue) noexcept : r(red), g(green), b(blue) {}
  constexpr Rgb(double grey) noexcept : Rgb(grey, grey, grey) {}  // NOLINT: a number is a grey colour

  friend constexpr bool operator==(const Rgb&, const Rgb&) = default;
  friend constexpr Rgb operator+(Rgb p, Rgb q) noexcept { return {p.r + q.r, p.g + q.g, p.b + q.b}; }
  friend constexpr Rgb operator*(Rgb p, Rgb q) noexcept { return {p.r * q.r, p.g * q.g, p.b * q.b}; }
};

}  // namespace burnish
