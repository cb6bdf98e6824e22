// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/parameterization/visible_half.h>
#include <burnish/reflectance/half_vector_quadrature.h>

namespace burnish {

std::vector<DirectionWeight> half_vector_quadrature(Vec3 wo, int azimuths, int radii) {
  // Radii are spaced evenly in the logarithm of m = tan^2(theta_h / 2), over a range of 1e9 up to the largest visible
  // one.
  const double log_range = std::log(1e9), step = log_range / radii;
  std::vector<DirectionWeight> rule;
  rule.reserve(static_cast<std::size_t>(azimuths) * static_cast<std::size_t>(radii));
  const double first_phi = std::atan2(wo.y, wo.x);
  for (int i = 0; i < azimuths; ++i) {
    const double phi = first_phi + kTwoPi * (i + 0.5) / azimuths, x = std::cos(phi), y = std::sin(phi);
    const double along = wo.x * x + wo.y * y, largest = largest_visible_half(along, wo.z);
    for (int k = 0; k < radii; ++k) {
      const double m = largest * std::exp(step * (k + 0.5) - log_range);
      // The half vector of azimuth phi and m gives wi by reflection of wo.
      const double sine = 2 * std::sqrt(m) / (1 + m), cosine = (1 - m) / (1 + m);
      const double to_half = along * sine + wo.z * cosine;
      const Vec3 wi = 2 * to_half * Vec3{sine * x, sine * y, cosine} - wo;
      // The weight is wi's solid angle: that of h is 2 dm dphi / (1 + m)^2, and that of wi 4 wo.h times it [Walter
      // 2007, eq. 14].
      const double weight = 8 * to_half * m * step / ((1 + m) * (1 + m)) * kTwoPi / azimuths;
      if (wi.z > 0) rule.push_back({wi, weight});
    }
  }
  return rule;
}

double reflected_size(BrdfRef brdf, Vec3 wi, Vec3 wo, std::span<double> scratch) noexcept {
  brdf.eval(wi, wo, scratch);
  double squares = 0;
  for (const double f : scratch) squares += f * f;
  return std::sqrt(squares / static_cast<double>(scratch.size())) * wi.z;
}

}  // namespace burnish
