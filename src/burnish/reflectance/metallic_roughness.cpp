// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/reflectance/metallic_roughness.h>

namespace burnish {

bool MetallicRoughness::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::ranges::fill(f, 0.0);
  if (wi.z <= 0 || wo.z <= 0) return true;
  const Vec3 h = half_vector(wi, wo);
  const double alpha = roughness * roughness, along = alpha + (1 - alpha) * anisotropy * anisotropy;
  const double ax = across ? alpha : along, ay = across ? along : alpha;
  const double x = h.x / ax, y = h.y / ay, d = x * x + y * y + h.z * h.z;
  const double distribution = 1 / (kPi * ax * ay * d * d);
  const auto stretched = [&](Vec3 w) { return length({ax * w.x, ay * w.y, w.z}); };
  const double visibility = 0.5 / (wi.z * stretched(wo) + wo.z * stretched(wi));
  const double grazing = std::pow(1 - std::min(dot(wi, h), 1.0), 5);
  const double base[] = {base_color.r, base_color.g, base_color.b};
  for (std::size_t c = 0; c < 3; ++c) {
    const double f0 = 0.04 + (base[c] - 0.04) * metallic, fresnel = f0 + (1 - f0) * grazing;
    f[c] = (1 - fresnel) * (1 - metallic) * base[c] / kPi + fresnel * distribution * visibility;
  }
  return true;
}

}  // namespace burnish
