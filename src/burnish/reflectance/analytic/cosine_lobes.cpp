// SPDX-License-Identifier: Apache-2.0
#include <burnish/reflectance/analytic/cosine_lobes.h>

namespace burnish {

bool Phong::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry&) {
    const double cos_gamma = std::clamp(wi.z * wo.z - wi.x * wo.x - wi.y * wo.y, 0.0, 1.0);
    const double scale = normalized ? phong_normalization(exponent) : 1;
    return diffuse(kd) + scale * std::pow(cos_gamma, exponent) * ks;
  });
}

bool BlinnPhong::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry& g) {
    const double scale = normalized ? blinn_phong_normalization(exponent) : 1;
    return diffuse(kd) + scale * std::pow(g.h.z, exponent) * ks;
  });
}

bool Lafortune::isotropic() const noexcept {
  return std::all_of(lobes.begin(), lobes.end(),
                     [](const Lobe& lobe) { return lobe.cx == lobe.cy || lobe.ks == Rgb{}; });
}

bool Lafortune::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry&) {
    Rgb value = diffuse(kd);
    for (const Lobe& lobe : lobes) {
      const double c = lobe.cx * (wi.x * wo.x) + lobe.cy * (wi.y * wo.y) + lobe.cz * (wi.z * wo.z);
      if (c > 0 && lobe.ks != Rgb{}) value = value + std::pow(c, lobe.exponent) * lobe.ks;
    }
    return value;
  });
}

}  // namespace burnish
