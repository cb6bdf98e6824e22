#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr double kFloor = 1e-3;  // 1/sr, of ratios of values

/// Mean colour of a pair over azimuths of both together; grey of one channel.
Rgb mean_value(BrdfRef brdf, Vec3 wi, Vec3 wo, bool isotropic) {
  const int azimuths = isotropic ? 1 : 4;
  Rgb sum;
  for (int i = 0; i < azimuths; ++i) {
    const double phi = kTwoPi * i / azimuths, c = std::cos(phi), s = std::sin(phi);
    const auto turned = [&](Vec3 w) { return Vec3{c * w.x - s * w.y, s * w.x + c * w.y, w.z}; };
    std::array<double, 3> f{};
    if (!brdf.eval(turned(wi), turned(wo), std::span(f).first(brdf.channels()))) continue;
    if (brdf.channels() == 1) f[1] = f[2] = f[0];
    sum = sum + Rgb(f[0], f[1], f[2]);
  }
  return 1.0 / azimuths * sum;
}

double luminance(Rgb f) {
  return 0.2126 * f.r + 0.7152 * f.g + 0.0722 * f.b;
}

double backscatter(BrdfRef brdf, bool isotropic) {
  double sum = 0;
  for (int theta_deg = 20; theta_deg <= 60; theta_deg += 5) {
    const Vec3 w = spherical_direction(radians(theta_deg), 0);
    sum += luminance(mean_value(brdf, w, w, isotropic));
  }
  return sum + kFloor;
}

/// Greatest factor by which values rise again as theta_h grows.
double greatest_rise(BrdfRef brdf, bool isotropic) {
  double greatest = 1;
  for (const double theta_d_deg : {15.0, 40.0}) {
    double least = INFINITY;
    for (int theta_h_deg = 0; theta_h_deg <= 60; theta_h_deg += 2) {
      // the difference vector across the plane of h and the normal: both directions at one height
      const Vec3 h = spherical_direction(radians(theta_h_deg), 0);
      const Vec3 aside = std::sin(radians(theta_d_deg)) * Vec3{0, 1, 0},
                 along = std::cos(radians(theta_d_deg)) * h;
      const double value = luminance(mean_value(brdf, along + aside, along - aside, isotropic)) + kFloor;
      least = std::min(least, value);
      greatest = std::max(greatest, value / least);
    }
  }
  return greatest;
}

double greatest_colour_shift(BrdfRef source, BrdfRef material, bool isotropic) {
  double greatest = 0;
  for (int theta_deg = 0; theta_deg <= 75; theta_deg += 5) {
    const Vec3 wi = spherical_direction(radians(theta_deg), 0);
    const auto chromaticity = [&](BrdfRef brdf) {
      const Rgb f = mean_value(brdf, wi, mirror(wi), isotropic);
      return 1 / std::max(f.r + f.g + f.b, kFloor) * f;
    };
    const Rgb difference = chromaticity(source) + -1.0 * chromaticity(material);
    greatest = std::max(greatest, std::hypot(difference.r, difference.g, difference.b));
  }
  return greatest;
}

}  // namespace

Unexplained unexplained(BrdfRef source, BrdfRef material) {
  const bool isotropic = source.isotropic() && material.isotropic();
  return {.backscatter = backscatter(source, isotropic) / backscatter(material, isotropic),
          .rings = std::max(1.0, greatest_rise(source, isotropic) / greatest_rise(material, isotropic)),
          .colour_shift = greatest_colour_shift(source, material, isotropic)};
}

}  // namespace burnish
