// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include <burnish/math/rgb.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

class Expr;

/// The inputs of OpenPBR Surface 1.1 that reflection at an opaque surface sees, under the specification's names and
/// with its defaults; ranges in kOpenPbrInputs. Source: [OpenPBR 2024].
struct OpenPbrParameters {
  double base_weight = 1;
  Rgb base_color = 0.8;
  double base_metalness = 0;
  double base_diffuse_roughness = 0;

  double specular_weight = 1;
  Rgb specular_color = 1;
  double specular_roughness = 0.3;
  double specular_roughness_anisotropy = 0;
  double specular_ior = 1.5;

  double coat_weight = 0;
  Rgb coat_color = 1;
  double coat_roughness = 0;
  double coat_roughness_anisotropy = 0;
  double coat_ior = 1.6;
  double coat_darkening = 1;

  double fuzz_weight = 0;
  Rgb fuzz_color = 1;
  double fuzz_roughness = 0.5;

  double thin_film_weight = 0;
  double thin_film_thickness = 0.5;  ///< micrometres
  double thin_film_ior = 1.4;

  double geometry_tangent = 0;  ///< degrees from the x axis, counterclockwise

  friend bool operator==(const OpenPbrParameters&, const OpenPbrParameters&) = default;
};

/// One of the inputs: its name in the specification, what it is, the range we take (both allowed) and its place.
struct OpenPbrInput {
  std::string_view name, description;
  double min, max;
  std::variant<double OpenPbrParameters::*, Rgb OpenPbrParameters::*> member;
};

/// All inputs, in the order of OpenPbrParameters. Indices of refraction end at 5 and the film at 5 micrometres, where
/// the specification has no bound; specular_weight ends at 1, above which it has no meaning for metals. The tangents of base
/// and coat, vectors in the specification, are one angle.
inline constexpr std::array<OpenPbrInput, 22> kOpenPbrInputs = {{
    {"base_weight", "multiplier of base_color", 0, 1, &OpenPbrParameters::base_weight},
    {"base_color", "colour of the diffuse or metallic base", 0, 1, &OpenPbrParameters::base_color},
    {"base_metalness", "share of metal in the base", 0, 1, &OpenPbrParameters::base_metalness},
    {"base_diffuse_roughness", "roughness of the diffuse base", 0, 1,
     &OpenPbrParameters::base_diffuse_roughness},
    {"specular_weight", "multiplier of the base's specular reflectance", 0, 1,
     &OpenPbrParameters::specular_weight},
    {"specular_color", "tint of a dielectric's highlight, a metal's colour at 82 degrees", 0, 1,
     &OpenPbrParameters::specular_color},
    {"specular_roughness", "roughness of the base's highlight, root of alpha", 0, 1,
     &OpenPbrParameters::specular_roughness},
    {"specular_roughness_anisotropy", "stretch of the base's highlight along the tangent", 0, 1,
     &OpenPbrParameters::specular_roughness_anisotropy},
    {"specular_ior", "index of refraction of the dielectric base", 1, 5, &OpenPbrParameters::specular_ior},
    {"coat_weight", "presence of the clear coat", 0, 1, &OpenPbrParameters::coat_weight},
    {"coat_color", "transmittance of the coat", 0, 1, &OpenPbrParameters::coat_color},
    {"coat_roughness", "roughness of the coat's highlight", 0, 1, &OpenPbrParameters::coat_roughness},
    {"coat_roughness_anisotropy", "stretch of the coat's highlight along the tangent", 0, 1,
     &OpenPbrParameters::coat_roughness_anisotropy},
    {"coat_ior", "index of refraction of the coat", 1, 5, &OpenPbrParameters::coat_ior},
    {"coat_darkening", "share of the darkening by reflections inside the coat", 0, 1,
     &OpenPbrParameters::coat_darkening},
    {"fuzz_weight", "presence of the fuzz", 0, 1, &OpenPbrParameters::fuzz_weight},
    {"fuzz_color", "colour of the fuzz", 0, 1, &OpenPbrParameters::fuzz_color},
    {"fuzz_roughness", "roughness of the fuzz", 0, 1, &OpenPbrParameters::fuzz_roughness},
    {"thin_film_weight", "share covered by a thin film on the base", 0, 1,
     &OpenPbrParameters::thin_film_weight},
    {"thin_film_thickness", "thickness of the film, micrometres", 0, 5,
     &OpenPbrParameters::thin_film_thickness},
    {"thin_film_ior", "index of refraction of the film", 1, 5, &OpenPbrParameters::thin_film_ior},
    {"geometry_tangent", "degrees by which the tangent is turned about the normal", 0, 180,
     &OpenPbrParameters::geometry_tangent},
}};

/// OpenPBR Surface 1.1 as MaterialX 1.39 makes shaders of it, without transmission, subsurface and emission: fuzz over
/// coat over a mixture of metal and glossy-diffuse base, each layer letting through what its directional albedo towards
/// the viewer leaves. Facets are GGX with Smith's masking of the mean roughness and lose no energy to multiple
/// reflections [Turquin 2019]; the dielectric's Fresnel factor is exact, the metal's is Schlick's with a tint at 82
/// degrees [Hoffman 2019], under a film Airy's with two orders of interference, antialiased spectrally [Belcour 2017];
/// the diffuse base is Fujii's with what it loses given back, the fuzz a linearly transformed cosine [Zeltner 2022].
/// Values below 0, which the metal's factor has for dark specular_color, become 0. Not reciprocal: the layers see the
/// viewer alone. Domain: parameters in the ranges of kOpenPbrInputs. Channels: 3. Source: [OpenPBR 2024].
class OpenPbr {
 public:
  explicit OpenPbr(const OpenPbrParameters& parameters = {}) noexcept;

  static constexpr std::size_t channels() noexcept { return 3; }
  bool isotropic() const noexcept;
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  const OpenPbrParameters& parameters() const noexcept { return p_; }

 private:
  friend class OpenPbrVariants;
  friend Expr openpbr_expression(const OpenPbr& material);

  // The formulas, over double or nodes of expression graphs.
  template <class T>
  struct Geometry;
  template <class T>
  struct Layer;
  template <class T>
  struct Highlight;
  template <class T>
  struct Parts;

  /// The parts of a value, in the order in which one needs another.
  enum Part { film, facets, base_diffuse, gloss, metal, coating, fuzz, part_count };
  using PartSet = std::bitset<part_count>;

  /// GGX roughnesses: along the tangent, across, and their geometric mean.
  struct Roughness {
    double x, y, mean;

    friend bool operator==(const Roughness&, const Roughness&) = default;
  };
  static Roughness roughness(double roughness, double anisotropy) noexcept;

  /// The direction as seen with the tangent as x axis.
  template <class Vector>
  Vector in_tangent_frame(const Vector& w) const;
  template <class T>
  Highlight<T> highlight(const Roughness& alpha, const Geometry<T>& g) const;
  template <class T>
  auto dielectric_under_film(const Parts<T>& parts, const Geometry<T>& g) const;
  template <class T>
  auto metal_fresnel(const T& cosine) const;
  template <class T>
  auto metal_under_film(const Parts<T>& parts, const Geometry<T>& g) const;
  template <class T>
  auto diffuse_base(const Geometry<T>& g) const;
  template <class T>
  Layer<T> gloss_layer(const Parts<T>& parts, const Geometry<T>& g) const;
  template <class T>
  auto metal_base(const Parts<T>& parts, const Geometry<T>& g) const;
  template <class T>
  Layer<T> coat_layer(const Geometry<T>& g) const;
  template <class T>
  Layer<T> fuzz_layer(const Geometry<T>& g) const;

  PartSet needed() const noexcept;
  PartSet needed_beside(const OpenPbr& other) const noexcept;
  template <class T>
  void compute(const PartSet& which, const Geometry<T>& g, Parts<T>& parts) const;
  template <class T>
  auto join(const Parts<T>& parts) const;

  OpenPbrParameters p_;
  Roughness base_alpha_, coat_alpha_;
  double tangent_cos_, tangent_sin_;
  double base_ior_;  ///< of the dielectric base against what lies on it, scaled by specular_weight
  Rgb metal_f0_;
  Rgb under_coat_;  ///< what the coat's colour and the reflections inside it leave of the base
};

static_assert(Brdf<OpenPbr>);

/// A material and others that differ from it in an input or a few, evaluated side by side: of those only what differs
/// is computed. All have the same tangent. The same bits as each one's OpenPbr::eval.
class OpenPbrVariants {
 public:
  OpenPbrVariants(const OpenPbr& material, std::vector<OpenPbr> others);

  /// Three values a material, the first's first. Precondition: f.size() == 3 * (1 + others).
  void eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

 private:
  OpenPbr material_;
  std::vector<OpenPbr> others_;
  std::vector<OpenPbr::PartSet> fresh_;  ///< of each of the others: what the first has not
};

}  // namespace burnish
