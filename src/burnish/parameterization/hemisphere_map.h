// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include <burnish/math/vec3.h>

namespace burnish {

/// tan(theta / 2) = |xy| / (1 + z) of a direction with z >= 0: 0 at the normal, 1 at the horizon.
inline double tan_half_theta(Vec3 w) noexcept {
  return std::sqrt(w.x * w.x + w.y * w.y) / (1 + w.z);
}

/// Which monotone map of [0, 1] onto itself spaces a table's nodes in t = tan(theta / 2).
enum class WarpKind { identity, power, rational };

/// u = forward(t), t = inverse(u):
/// - identity: u = t, the parabolic map of the paper;
/// - power: u = t^parameter, parameter in (0, 1]; below 1 more nodes near the normal (1/2: t quadratic in u);
/// - rational: u = t (1 + k) / (t + k), one division; k = parameter > 0 crowds the nodes at the normal, where
///   their density is (1 + k) / k times the uniform one, k < -1 at the horizon, where it is k / (1 + k) times
///   that.
struct Warp {
  WarpKind kind = WarpKind::identity;
  double parameter = 1;

  double forward(double t) const noexcept;
  double inverse(double u) const noexcept {
    if (kind == WarpKind::rational) return u * parameter / (1 + parameter - u);
    return kind == WarpKind::power ? std::pow(u, 1 / parameter) : u;
  }

  friend bool operator==(const Warp&, const Warp&) = default;
};

/// Reads "identity", "power:0.5" or "rational:0.1". Throws Error on anything else or a parameter out of
/// range.
Warp parse_warp(std::string_view text);
/// The text parse_warp reads; the parameter with the digits that restore it.
std::string to_string(Warp warp);

/// A point of the unit disk that a hemisphere is mapped to.
struct DiskPoint {
  double x = 0, y = 0;
};

/// Parabolic map with radial warp: direction w, z >= 0, to xy / (1 + z), its radius passed through the warp.
/// With the identity warp it is the paper's parabolic map.
inline DiskPoint to_disk(Vec3 w, Warp warp) noexcept {
  const double scale = 1 / (1 + w.z);
  if (warp.kind == WarpKind::identity) return {w.x * scale, w.y * scale};
  const double t = tan_half_theta(w);
  if (t <= 0) return {0, 0};
  const double stretch = warp.forward(t) / t * scale;
  return {w.x * stretch, w.y * stretch};
}

/// Inverse of to_disk for points of the unit disk; points outside it (the corners of a square texture) are
/// taken to the horizon along their radius.
Vec3 from_disk(DiskPoint p, Warp warp) noexcept;

}  // namespace burnish
