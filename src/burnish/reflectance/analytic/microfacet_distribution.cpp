// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/reflectance/analytic/microfacet_distribution.h>

namespace burnish {

double gaussian_of_slopes(Vec3 h, double alpha_x, double alpha_y) noexcept {
  constexpr double kNegligible = 700;  // exp(-700) is 1e-304
  const double x = h.x / alpha_x, y = h.y / alpha_y, square = x * x + y * y, z2 = h.z * h.z;
  return square < kNegligible * z2 ? std::exp(-square / z2) : 0;
}

double BeckmannDistribution::density(Vec3 h) const noexcept {
  const double gauss = gaussian_of_slopes(h, alpha_x, alpha_y), z2 = h.z * h.z;
  return gauss > 0 ? gauss / (kPi * alpha_x * alpha_y * z2 * z2) : 0;  // [Walter 2007, eq. 25]
}

double BeckmannDistribution::projected_area(Vec3 w) const noexcept {
  const double s = std::hypot(alpha_x * w.x, alpha_y * w.y);
  if (s <= 0) return w.z;
  const double a = w.z / s;
  return 0.5 * (w.z * (1 + std::erf(a)) + s * std::exp(-a * a) * std::numbers::inv_sqrtpi);
}

double GgxDistribution::density(Vec3 h) const noexcept {
  const double x = h.x / alpha_x, y = h.y / alpha_y, q = x * x + y * y + h.z * h.z;
  return 1 / (kPi * alpha_x * alpha_y * q * q);  // [Walter 2007, eq. 33]
}

double GgxDistribution::projected_area(Vec3 w) const noexcept {
  return 0.5 * (w.z + std::sqrt(alpha_x * alpha_x * w.x * w.x + alpha_y * alpha_y * w.y * w.y + w.z * w.z));
}

double CrossedGaussians::density(Vec3 h) const noexcept {
  return (1 - cross) * BeckmannDistribution{alpha_x, alpha_y}.density(h) +
         cross * BeckmannDistribution{alpha_y, alpha_x}.density(h);
}

}  // namespace burnish
