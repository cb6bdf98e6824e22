// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include <burnish/fitting/parametric/grain.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>

namespace burnish {

namespace {

constexpr int kAzimuthStep = 5;     // degrees
constexpr double kMinGrain = 0.02;  // of what is reflected, that goes about with the direction
constexpr double kAxisReach = 3;    // degrees

/// Returns f at half vectors that lean to both sides at an azimuth; nothing where none of them is known.
std::optional<double> reflected(BrdfRef source, double phi) {
  double sum = 0;
  bool known = false;
  std::vector<double> f(source.channels());
  for (int theta_h_deg = 10; theta_h_deg <= 40; theta_h_deg += 5)
    for (const double side : {phi, phi + kPi}) {
      const auto [wi, wo] = from_half_diff(
          {.theta_h = radians(theta_h_deg), .phi_h = side, .theta_d = radians(15), .phi_d = kHalfPi});
      if (!source.eval(wi, wo, f)) continue;
      sum += std::accumulate(f.begin(), f.end(), 0.0);
      known = true;
    }
  return known ? std::optional(sum) : std::nullopt;
}

}  // namespace

double grain_direction(BrdfRef source) {
  if (source.isotropic()) return 0;
  // least squares of the differences between azimuths across each other, 2 (a cos 2 phi + b sin 2 phi)
  double cc = 0, cs = 0, ss = 0, c_right = 0, s_right = 0, all = 0;
  for (int azimuth = 0; azimuth < 90; azimuth += kAzimuthStep) {
    const double phi = radians(azimuth), c = std::cos(2 * phi), s = std::sin(2 * phi);
    const auto along = reflected(source, phi), across = reflected(source, phi + kHalfPi);
    if (!along || !across) continue;
    const double half = (*along - *across) / 2;
    cc += c * c;
    cs += c * s;
    ss += s * s;
    c_right += c * half;
    s_right += s * half;
    all += (*along + *across) / 2;
  }
  const double determinant = cc * ss - cs * cs, count = cc + ss;
  double a = 0, b = 0;
  if (determinant > 1e-6 * count * count) {
    a = (ss * c_right - cs * s_right) / determinant;
    b = (cc * s_right - cs * c_right) / determinant;
  } else if (count > 0) {
    a = c_right / count;  // one pair of azimuths
    b = s_right / count;
  }
  if (!(std::hypot(a, b) * count > kMinGrain * all)) return 0;
  const double found = std::fmod(degrees(std::atan2(b, a) / 2) + 180, 180);
  for (const double axis : {0.0, 90.0, 180.0})
    if (std::abs(found - axis) <= kAxisReach) return std::fmod(axis, 180);
  return std::round(10 * found) / 10;
}

}  // namespace burnish
