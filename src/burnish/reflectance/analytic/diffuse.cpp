// SPDX-License-Identifier: Apache-2.0
#include <burnish/reflectance/analytic/diffuse.h>

namespace burnish {

bool Lambert::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry&) { return diffuse(kd); });
}

bool OrenNayar::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry& g) {
    const double sin_i = std::hypot(wi.x, wi.y), sin_o = std::hypot(wo.x, wo.y);
    const double across = sin_i * sin_o;
    const double cos_phi = across > 0 ? std::clamp((wi.x * wo.x + wi.y * wo.y) / across, -1.0, 1.0) : 1;
    const double theta_i = std::atan2(sin_i, g.cos_i), theta_o = std::atan2(sin_o, g.cos_o);
    const double alpha = std::max(theta_i, theta_o), beta = std::min(theta_i, theta_o);

    const double s2 = sigma * sigma, b = beta / kHalfPi;
    const double c1 = 1 - 0.5 * s2 / (s2 + 0.33);
    const double c2 = 0.45 * s2 / (s2 + 0.09) * (std::sin(alpha) - (cos_phi < 0 ? b * b * b : 0));
    const double ab = alpha * beta / (kHalfPi * kHalfPi);
    const double c3 = 0.125 * s2 / (s2 + 0.09) * ab * ab;
    const double direct =
        c1 + cos_phi * c2 * std::tan(beta) + (1 - std::abs(cos_phi)) * c3 * std::tan(0.5 * (alpha + beta));
    const double twice = 0.17 * s2 / (s2 + 0.13) * (1 - cos_phi * b * b);
    const auto channel = [&](double k) { return std::max(0.0, k / kPi * (direct + twice * k)); };
    return Rgb{channel(kd.r), channel(kd.g), channel(kd.b)};
  });
}

}  // namespace burnish
