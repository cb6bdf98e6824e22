#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/parameterization/projection.h>
#include <burnish/reflectance/brdf.h>

namespace burnish::testing {

/// albedo / pi in every direction; one channel or three.
struct Lambert {
  std::array<double, 3> albedo = {0.8, 0.5, 0.2};
  int count = 3;

  int channels() const noexcept { return count; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = wi.z > 0 && wo.z > 0 ? albedo[c] / kPi : 0;
    return true;
  }
};

/// Lambert plus a lobe exp(-a hx^2 - b hy^2), scaled; stretched along the tangent where a != b; knows nothing
/// where cos theta_d is below `blind_below`.
struct Glossy {
  double a = 40, b = 40, scale = 1, blind_below = -1;
  int count = 3;

  int channels() const noexcept { return count; }
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

/// Glossy times 1 + slope cos theta_i in the first channel, 1 - slope cos theta_i / 2 in the others: isotropic, but not
/// reciprocal.
struct Ordered {
  Glossy even;
  double slope = 0.5;

  int channels() const noexcept { return even.channels(); }
  bool isotropic() const noexcept { return even.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const bool known = even.eval(wi, wo, f);
    for (std::size_t c = 0; c < f.size(); ++c)
      f[c] *= 1 + (c == 0 ? slope : -0.5 * slope) * std::max(wi.z, 0.0);
    return known;
  }
};

/// Glossy, brighter on one side of the plane of h and n than on the other: isotropic, reciprocal, but not its
/// own mirror image.
struct Twisted {
  Glossy even;
  double slope = 1.5;

  int channels() const noexcept { return even.channels(); }
  bool isotropic() const noexcept { return even.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const double side = project_tan_half(kProjectTwist, wi, wo) - 0.5;
    const bool known = even.eval(wi, wo, f);
    for (double& v : f) v *= std::exp(slope * side);
    return known;
  }
};

}  // namespace burnish::testing
