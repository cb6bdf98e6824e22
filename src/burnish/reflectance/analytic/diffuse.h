// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/analytic/pair_geometry.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Light leaves alike in all directions, kd / pi. Reciprocal, conserving. Source: [Lambert 1760].
struct Lambert {
  Rgb kd = 0.5;

  static constexpr std::size_t channels() noexcept { return 3; }
  static constexpr bool isotropic() noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

/// V-grooves with Lambertian walls whose slopes are Gaussian with deviation `sigma` (radians, in [0, pi/2]):
/// the full functional approximation, with masking, shadowing and one interreflection, not the shorter
/// "qualitative" one. Its fit dips below zero where both directions graze in opposite azimuths; we clamp
/// there. Reciprocal; conserving for kd <= 0.9, at kd = 1 up to 5 % above. Source: [Oren 1994].
struct OrenNayar {
  Rgb kd = 0.5;
  double sigma = 0.5;

  static constexpr std::size_t channels() noexcept { return 3; }
  static constexpr bool isotropic() noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

static_assert(Brdf<Lambert> && Brdf<OrenNayar>);

}  // namespace burnish
