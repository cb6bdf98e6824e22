// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/analytic/fresnel.h>
#include <burnish/reflectance/analytic/microfacet_distribution.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// D G / (4 cos_i cos_o), 1/sr, with Smith's height-correlated G. Source: [Walter 2007, eq. 20], G [Heitz 2014, eq. 99].
template <MicrofacetDistribution Distribution>
double facets(const Distribution& distribution, const PairGeometry& g) noexcept {
  // cos_i cos_o / G = cos_i cos_o (1 + Lambda_i + Lambda_o), in projected areas cos (1 + Lambda).
  const double area_i = distribution.projected_area(g.wi), area_o = distribution.projected_area(g.wo);
  const double visible = area_i * g.cos_o + area_o * g.cos_i - g.cos_i * g.cos_o;
  return distribution.density(g.h) / (4 * visible);
}

/// Specular microfacets with Smith's height-correlated masking and shadowing and Schlick's Fresnel factor,
/// plus kd / pi: f = D F G / (4 cos_i cos_o). Reciprocal; conserving for kd = 0.
/// Source: [Walter 2007, eq. 20], G [Heitz 2014, eq. 99].
template <MicrofacetDistribution Distribution>
struct Microfacet {
  Distribution distribution;
  Rgb f0 = 0.9;
  Rgb kd = 0;

  static constexpr std::size_t channels() noexcept { return 3; }
  bool isotropic() const noexcept { return distribution.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    return eval_above_horizon(wi, wo, f, [&](const PairGeometry& g) {
      return diffuse(kd) + facets(distribution, g) * fresnel_schlick(f0, g.cos_d);
    });
  }
};

using Ggx = Microfacet<GgxDistribution>;
using Beckmann = Microfacet<BeckmannDistribution>;

/// Beckmann-distributed facets in V-cavities with the Fresnel factor of a dielectric, plus kd / pi. The paper
/// divides by pi where the exact geometry gives 4 [Walter 2007, eq. 20]; we divide by 4 and use the
/// normalized distribution, so that light is conserved for kd = 0. Reciprocal. Source: [Cook 1982].
struct CookTorrance {
  double alpha = 0.2;  ///< the paper's m, rms slope, in [0.001, 1]
  Rgb f0 = 0.5;        ///< reflectance at normal incidence, from which the index follows
  Rgb kd = 0;

  static constexpr std::size_t channels() noexcept { return 3; }
  static constexpr bool isotropic() noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

/// Anisotropic Phong-like lobe (n·h)^(exponent_x cos² + exponent_y sin²) with Schlick's Fresnel factor, and a
/// diffuse term that gives way to it at grazing angles. Reciprocal, conserving.
/// Source: [Ashikhmin 2000b, eq. 4, 5].
struct AshikhminShirley {
  double exponent_x = 100, exponent_y = 100;  ///< along the tangent and across, in [0, 100000]
  Rgb f0 = 0.3;
  Rgb kd = 0.3;

  static constexpr std::size_t channels() noexcept { return 3; }
  bool isotropic() const noexcept { return exponent_x == exponent_y; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

static_assert(Brdf<Ggx> && Brdf<Beckmann> && Brdf<CookTorrance> && Brdf<AshikhminShirley>);

}  // namespace burnish
