// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <burnish/math/quadrature.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Integrates over the upper hemisphere, by Gauss-Legendre in theta = (pi/2) v² and equal steps in azimuth.
template <int kPolar = 96, int kAzimuths = 256, class Integrand>
double over_hemisphere(const Integrand& integrand) {
  return integrate<kPolar>(0, 1, [&](double v) {
    const double theta = kHalfPi * v * v;
    double sum = 0;
    for (int i = 0; i < kAzimuths; ++i) sum += integrand(spherical_direction(theta, kTwoPi * i / kAzimuths));
    return sum * std::sin(theta) * kPi * v * kTwoPi / kAzimuths;
  });
}

/// Returns the share of light reflected towards wo under uniform illumination (first channel). The integral
/// runs over the half vector, where narrow lobes are smooth.
template <int kPolar = 96, int kAzimuths = 256, Brdf T>
double albedo(const T& brdf, Vec3 wo) {
  std::array<double, 3> f;
  return over_hemisphere<kPolar, kAzimuths>([&](Vec3 h) {
    const double cosine = dot(wo, h);
    const Vec3 wi = 2 * cosine * h - wo;
    if (cosine <= 0 || wi.z <= 0) return 0.0;
    brdf.eval(wi, wo, f);
    return f[0] * wi.z * 4 * cosine;
  });
}

}  // namespace burnish
