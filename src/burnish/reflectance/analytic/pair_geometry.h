// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include <burnish/math/angles.h>
#include <burnish/math/rgb.h>
#include <burnish/math/vec3.h>

namespace burnish {

/// Cosines to the normal below this count as this much where a model divides by them, so that every value is
/// finite. No other direction is changed.
inline constexpr double kMinCosine = 1e-12;

/// The quantities that the analytic models need of a pair of directions above the horizon, symmetric in the two to
/// the last bit.
struct PairGeometry {
  Vec3 wi, wo;
  double cos_i, cos_o;  ///< to the normal, at least kMinCosine
  Vec3 sum;             ///< wi + wo
  Vec3 h;               ///< half vector
  double cos_d;         ///< of the difference angle, wi·h = wo·h = |wi + wo| / 2, at least kMinCosine

  PairGeometry(Vec3 to_light, Vec3 to_viewer) noexcept
      : wi(to_light),
        wo(to_viewer),
        cos_i(std::max(wi.z, kMinCosine)),
        cos_o(std::max(wo.z, kMinCosine)),
        sum(wi + wo),
        h(half_vector(wi, wo)),
        cos_d(std::clamp(0.5 * length(sum), kMinCosine, 1.0)) {}
};

/// Fills f with value(geometry), or with zeros below the horizon; the body of every model's eval.
template <class Value>
bool eval_above_horizon(Vec3 wi, Vec3 wo, std::span<double> f, const Value& value) noexcept {
  assert(f.size() == 3);
  const Rgb v = wi.z > 0 && wo.z > 0 ? value(PairGeometry(wi, wo)) : Rgb{};
  f[0] = v.r;
  f[1] = v.g;
  f[2] = v.b;
  return true;
}

/// Lambert's f_r of a diffuse albedo kd, 1/sr.
constexpr Rgb diffuse(Rgb kd) noexcept {
  return (1 / kPi) * kd;
}

}  // namespace burnish
