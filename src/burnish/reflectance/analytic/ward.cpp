// SPDX-License-Identifier: Apache-2.0
#include <burnish/reflectance/analytic/microfacet_distribution.h>
#include <burnish/reflectance/analytic/ward.h>

namespace burnish {

namespace {

double normalization_divisor(Ward::Normalization normalization, const PairGeometry& g) noexcept {
  switch (normalization) {
    case Ward::Normalization::ward:
      return 4 * std::sqrt(g.cos_i * g.cos_o);
    case Ward::Normalization::duer:
      return 4 * g.cos_i * g.cos_o;
    case Ward::Normalization::bounded:
      break;
  }
  // Written in wi + wo: |sum|² = 4 cos_d², sum.z = 2 cos_d cos_h.
  const double z = std::max(g.sum.z, kMinCosine);
  return z * z * z * z / dot(g.sum, g.sum);
}

}  // namespace

bool Ward::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry& g) {
    const double gauss = gaussian_of_slopes(g.h, alpha_x, alpha_y);
    const double scale = kPi * alpha_x * alpha_y * normalization_divisor(normalization, g);
    return diffuse(kd) + (gauss > 0 ? gauss / scale : 0) * ks;
  });
}

}  // namespace burnish
