// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <burnish/math/rgb.h>
#include <burnish/math/vec3.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A material of glTF 2.0 with the extensions KHR_materials_ior, _specular, _anisotropy, _iridescence, _sheen and
/// _clearcoat, under their names: a coat over sheen over a mixture of metal and dielectric, all of GGX facets. A
/// lower layer loses the greatest channel of the light that is reflected above it. A film has Schlick's factors and
/// two orders of interference [Belcour 2017]; sheen is the "Charlie" distribution with its own masking, what lies
/// below scaled by its directional albedo [Estevez 2017]. Not reciprocal: the coat's factor sees the viewer alone.
/// Colours are linear Rec. 709. Channels: 3. Source: [glTF 2021] and the extensions' texts, their implementation
/// notes included.
struct GltfMaterial {
  Rgb base_color = 1;    ///< in [0, 1]
  double metallic = 1;   ///< in [0, 1]
  double roughness = 1;  ///< in [0.03, 1], root of the smaller alpha

  double ior = 1.5;        ///< of the dielectric, in [1, 5]
  double specular = 1;     ///< of the dielectric, in [0, 1]
  Rgb specular_color = 1;  ///< multiplies its reflectance at normal incidence, in [0, 1]
  double anisotropy = 0;   ///< strength in [0, 1]
  double rotation = 0;  ///< of where alphas are larger, radians from the tangent to the bitangent, in [0, pi)

  double iridescence = 0;              ///< share of a film, in [0, 1]
  double iridescence_ior = 1.3;        ///< in [1, 5]
  double iridescence_thickness = 400;  ///< nanometres

  Rgb sheen_color = 0;           ///< in [0, 1]
  double sheen_roughness = 0.5;  ///< in [0.07, 1], root of its alpha

  double clearcoat = 0;              ///< in [0, 1]
  double clearcoat_roughness = 0.1;  ///< in [0.03, 1]

  static std::size_t channels() noexcept { return 3; }
  bool isotropic() const noexcept { return anisotropy == 0; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  friend bool operator==(const GltfMaterial&, const GltfMaterial&) = default;
};

static_assert(Brdf<GltfMaterial>);

/// Directional albedo of sheen whose colour is 1, from a table: within .01 of the integral. Domain: cosine in [0, 1],
/// roughness in [0.07, 1].
double sheen_albedo(double cosine, double roughness) noexcept;

}  // namespace burnish
