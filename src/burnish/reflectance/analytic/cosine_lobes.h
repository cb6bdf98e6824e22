// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <burnish/reflectance/analytic/pair_geometry.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Factor that makes the lobe cos(gamma)^exponent about the mirror direction reflect all light at normal
/// incidence, and less elsewhere, 1/sr. Source: [Lafortune 1994].
constexpr double phong_normalization(double exponent) noexcept {
  return (exponent + 2) / kTwoPi;
}

/// Factor that makes the lobe (n·h)^exponent reflect all light at normal incidence, and less elsewhere, 1/sr:
/// with theta = 2 theta_h, the integral of cos(theta_h)^e cos(theta) over the hemisphere is
/// 8 pi (2^(-e/2) + e) / ((e + 2) (e + 4)).
inline double blinn_phong_normalization(double exponent) noexcept {
  return (exponent + 2) * (exponent + 4) / (8 * kPi * (std::exp2(-0.5 * exponent) + exponent));
}

/// kd / pi + ks s cos(gamma)^exponent with gamma between wo and the mirror image of wi; s is 1 or,
/// normalized, phong_normalization. The lobe stands in f_r itself: Phong's shading, which leaves the cosine
/// of the light out, is no reciprocal f_r. Reciprocal; conserving where normalized with kd + ks <= 1. Source:
/// [Phong 1975], normalization [Lafortune 1994].
struct Phong {
  Rgb kd = 0.2, ks = 0.8;
  double exponent = 20;
  bool normalized = true;

  static constexpr std::size_t channels() noexcept { return 3; }
  static constexpr bool isotropic() noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

/// kd / pi + ks s (n·h)^exponent; s is 1 or, normalized, blinn_phong_normalization. Reciprocal; conserving
/// where normalized with kd + ks <= 1. Source: [Blinn 1977].
struct BlinnPhong {
  Rgb kd = 0.2, ks = 0.8;
  double exponent = 80;
  bool normalized = true;

  static constexpr std::size_t channels() noexcept { return 3; }
  static constexpr bool isotropic() noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

/// kd / pi + sum over lobes of ks max(0, cx wi.x wo.x + cy wi.y wo.y + cz wi.z wo.z)^exponent.
/// cx = cy = -cz is Phong's lobe, |cz| < |cx| an off-specular one, positive cx a retroreflective one.
/// Reciprocal; conserving only for suitable coefficients. Source: [Lafortune 1997].
struct Lafortune {
  struct Lobe {
    double cx = -1, cy = -1, cz = 1, exponent = 20;
    Rgb ks;
  };
  Rgb kd = 0.2;
  std::array<Lobe, 3> lobes;

  static constexpr std::size_t channels() noexcept { return 3; }
  bool isotropic() const noexcept;
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

static_assert(Brdf<Phong> && Brdf<BlinnPhong> && Brdf<Lafortune>);

}  // namespace burnish
