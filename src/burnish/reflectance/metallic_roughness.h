// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <burnish/math/rgb.h>
#include <burnish/math/vec3.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// The core material of glTF 2.0 with KHR_materials_anisotropy: Lambert under GGX facets with
/// height-correlated masking and Schlick's Fresnel factor. Roughness alpha = roughness^2 across and
/// mix(alpha, 1, strength^2) along the direction of anisotropy, the tangent or, `across`, the bitangent. f0
/// is mix(0.04, base_color, metallic), what is not reflected goes to the diffuse colour (1 - metallic)
/// base_color. Channels: 3. Source: [glTF 2021, appendix B].
struct MetallicRoughness {
  Rgb base_color = 1;     ///< in [0, 1]
  double metallic = 1;    ///< in [0, 1]
  double roughness = 1;   ///< in [0.03, 1]
  double anisotropy = 0;  ///< strength in [0, 1]
  bool across = false;    ///< anisotropyRotation is pi/2

  static std::size_t channels() noexcept { return 3; }
  bool isotropic() const noexcept { return anisotropy == 0; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

static_assert(Brdf<MetallicRoughness>);

}  // namespace burnish
