// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/parameterization/projection.h>
#include <burnish/reflectance/brdf.h>

namespace burnish::fixtures {

/// albedo / pi in every direction; one channel or three.
struct Lambert {
  std::array<double, 3> albedo = {0.8, 0.5, 0.2};
  std::size_t count = 3;

  std::size_t channels() const noexcept { return count; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = wi.z > 0 && wo.z > 0 ? albedo[c] / kPi : 0;
    return true;
  }
};

/// Lambert plus a lobe exp(-a hx^2 - b hy^2), scaled. The lobe is stretched along the tangent if a != b.
/// Nothing is known where cos theta_d is below `blind_below`.
struct Glossy {
  double a = 40, b = 40, scale = 1, blind_below = -1;
  std::size_t count = 3;

  std::size_t channels() const noexcept { return count; }
  bool isotropic() const noexcept { return a == b; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const Vec3 h = half_vector(wi, wo);
    const bool above = wi.z > 0 && wo.z > 0, known = !above || dot(wi, h) >= blind_below;
    for (std::size_t c = 0; c < f.size(); ++c)
      f[c] = above && known
                 ? scale * (0.1 * (1 + static_cast<double>(c)) + 2 * std::exp(-a * h.x * h.x - b * h.y * h.y))
                 : 0;
    return known;
  }
};

/// Glossy times a factor of the directions in each channel, Factor::of(slope, channel, wi, wo) > 0. It is isotropic.
template <class Factor>
struct GlossyTimes {
  Glossy even;
  double slope = Factor::kSlope;

  std::size_t channels() const noexcept { return even.channels(); }
  bool isotropic() const noexcept { return even.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const bool known = even.eval(wi, wo, f);
    for (std::size_t c = 0; c < f.size(); ++c) f[c] *= Factor::of(slope, c, wi, wo);
    return known;
  }
};

/// 1 + slope cos theta_i in the first channel, 1 - slope cos theta_i / 2 in the other channels. It is not reciprocal.
struct OrderFactor {
  static constexpr double kSlope = 0.5;
  static double of(double slope, std::size_t c, Vec3 wi, Vec3) noexcept {
    return 1 + (c == 0 ? slope : -0.5 * slope) * std::max(wi.z, 0.0);
  }
};
using Ordered = GlossyTimes<OrderFactor>;

/// Brighter on one side of the plane of h and n than on the other. It is reciprocal, but not its own mirror image.
struct TwistFactor {
  static constexpr double kSlope = 1.5;
  static double of(double slope, std::size_t, Vec3 wi, Vec3 wo) noexcept {
    return std::exp(slope * (project_tan_half(kProjectTwist, wi, wo) - 0.5));
  }
};
using Twisted = GlossyTimes<TwistFactor>;

}  // namespace burnish::fixtures
