// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/math/angles.h>
#include <burnish/math/luminance.h>

namespace burnish {

namespace {

constexpr double kFloor = 1e-3;  // 1/sr, of ratios of values

/// The values of both.
struct Seen {
  Rgb source, material;
};

/// The colour of a pair, grey of one channel; nothing where it is not known.
std::optional<Rgb> value_of(BrdfRef brdf, Vec3 wi, Vec3 wo) {
  std::array<double, 3> f{};
  if (!brdf.eval(wi, wo, std::span(f).first(brdf.channels()))) return {};
  if (brdf.channels() == 1) f[1] = f[2] = f[0];
  return Rgb(f[0], f[1], f[2]);
}

/// Mean colours of a pair over the azimuths of both directions together at which both are known; nothing if none is.
std::optional<Seen> mean_seen(BrdfRef source, BrdfRef material, Vec3 wi, Vec3 wo) {
  const int azimuths = source.isotropic() && material.isotropic() ? 1 : 4;
  Seen sum;
  int known = 0;
  for (int i = 0; i < azimuths; ++i) {
    const double phi = kTwoPi * i / azimuths, c = std::cos(phi), s = std::sin(phi);
    const auto turned = [&](Vec3 w) { return Vec3{c * w.x - s * w.y, s * w.x + c * w.y, w.z}; };
    const auto of_source = value_of(source, turned(wi), turned(wo)),
               of_material = value_of(material, turned(wi), turned(wo));
    if (!of_source || !of_material) continue;
    sum = {sum.source + *of_source, sum.material + *of_material};
    ++known;
  }
  if (known == 0) return {};
  return Seen{1.0 / known * sum.source, 1.0 / known * sum.material};
}

/// Sums along wi = wo, source over material.
std::optional<double> backscatter(BrdfRef source, BrdfRef material) {
  double of_source = kFloor, of_material = kFloor;
  bool known = false;
  for (int theta_deg = 20; theta_deg <= 60; theta_deg += 5) {
    const Vec3 w = spherical_direction(radians(theta_deg), 0);
    const auto seen = mean_seen(source, material, w, w);
    if (!seen) continue;
    of_source += luminance(seen->source);
    of_material += luminance(seen->material);
    known = true;
  }
  if (!known) return {};
  return of_source / of_material;
}

/// The greatest factor by which values rise again.
class Rise {
 public:
  void add(double value) {
    least_ = std::min(least_, value + kFloor);
    greatest_ = std::max(greatest_, (value + kFloor) / least_);
  }
  void begin_again() { least_ = INFINITY; }
  double greatest() const { return greatest_; }

 private:
  double least_ = INFINITY, greatest_ = 1;
};

/// A pair about a half vector, with the difference vector across the plane of that and the normal: both directions at
/// one height.
DirectionPair level_pair(double theta_h, double phi_h, double theta_d) {
  const Vec3 along = std::cos(theta_d) * spherical_direction(theta_h, phi_h),
             aside = std::sin(theta_d) * Vec3{-std::sin(phi_h), std::cos(phi_h), 0};
  return {along + aside, along - aside};
}

/// Returns the ratio of the greatest rises as theta_h grows, source over material.
std::optional<double> rings(BrdfRef source, BrdfRef material) {
  Rise of_source, of_material;
  bool known = false;
  for (const double theta_d_deg : {15.0, 40.0}) {
    of_source.begin_again();
    of_material.begin_again();
    int count = 0;
    for (int theta_h_deg = 0; theta_h_deg <= 60; theta_h_deg += 2) {
      const auto [wi, wo] = level_pair(radians(theta_h_deg), 0, radians(theta_d_deg));
      const auto seen = mean_seen(source, material, wi, wo);
      if (!seen) continue;
      of_source.add(luminance(seen->source));
      of_material.add(luminance(seen->material));
      ++count;
    }
    known |= count > 1;
  }
  if (!known) return {};
  return std::max(1.0, of_source.greatest() / of_material.greatest());
}

std::optional<double> colour_shift(BrdfRef source, BrdfRef material) {
  std::optional<double> greatest;
  for (int theta_deg = 0; theta_deg <= 75; theta_deg += 5) {
    const Vec3 wi = spherical_direction(radians(theta_deg), 0);
    const auto seen = mean_seen(source, material, wi, mirror(wi));
    if (!seen) continue;
    const auto chromaticity = [](Rgb f) { return 1 / std::max(f.r + f.g + f.b, kFloor) * f; };
    const Rgb difference = chromaticity(seen->source) + -1.0 * chromaticity(seen->material);
    greatest = std::max(greatest.value_or(0), std::hypot(difference.r, difference.g, difference.b));
  }
  return greatest;
}

std::optional<double> grain(BrdfRef source, BrdfRef material) {
  double of_source[2] = {kFloor, kFloor}, of_material[2] = {kFloor, kFloor};  // along, across
  bool known = false;
  for (int theta_h_deg = 10; theta_h_deg <= 40; theta_h_deg += 5)
    for (int quarter = 0; quarter < 4; ++quarter) {
      const auto [wi, wo] = level_pair(radians(theta_h_deg), kHalfPi * quarter, radians(15));
      const auto at_source = value_of(source, wi, wo), at_material = value_of(material, wi, wo);
      if (!at_source || !at_material) continue;
      of_source[quarter % 2] += luminance(*at_source);
      of_material[quarter % 2] += luminance(*at_material);
      known = true;
    }
  if (!known) return {};
  return of_source[1] / of_source[0] / (of_material[1] / of_material[0]);
}

}  // namespace

Unexplained unexplained(BrdfRef source, BrdfRef material) {
  return {.backscatter = backscatter(source, material),
          .rings = rings(source, material),
          .colour_shift = colour_shift(source, material),
          .grain = grain(source, material)};
}

}  // namespace burnish
