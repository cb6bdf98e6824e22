// SPDX-License-Identifier: Apache-2.0
#include <burnish/reflectance/analytic/microfacet.h>

namespace burnish {

bool CookTorrance::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry& g) {
    const double density = BeckmannDistribution{alpha, alpha}.density(g.h);
    const double geometry = std::min(1.0, 2 * g.h.z * std::min(g.cos_i, g.cos_o) / g.cos_d);
    return diffuse(kd) + density * geometry / (4 * g.cos_i * g.cos_o) * fresnel_dielectric(f0, g.cos_d);
  });
}

bool AshikhminShirley::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry& g) {
    const double x2 = g.h.x * g.h.x, y2 = g.h.y * g.h.y, across = x2 + y2;
    const double exponent = across > 0 ? (exponent_x * x2 + exponent_y * y2) / across : 0;
    const double lobe = std::sqrt((exponent_x + 1) * (exponent_y + 1)) / (8 * kPi) *
                        std::pow(g.h.z, exponent) / (g.cos_d * std::max(g.cos_i, g.cos_o));
    const auto rise = [](double cosine) {
      const double m = 1 - 0.5 * cosine, m2 = m * m;
      return 1 - m2 * m2 * m;
    };
    const double under = 28 / (23 * kPi) * (rise(g.cos_i) * rise(g.cos_o));       // [Ashikhmin 2000b, eq. 5]
    return under * (kd * (1 + -1.0 * f0)) + lobe * fresnel_schlick(f0, g.cos_d);  // [Ashikhmin 2000b, eq. 4]
  });
}

}  // namespace burnish
