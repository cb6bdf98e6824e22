// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <burnish/reflectance/analytic/openpbr-inl.h>

namespace burnish {

OpenPbr::Roughness OpenPbr::roughness(double roughness, double anisotropy) noexcept {
  const double aspect = 1 - anisotropy, along = square(roughness) * std::sqrt(2 / (1 + square(aspect)));
  const double x = std::clamp(along, kEpsilon, 1.0), y = std::clamp(aspect * along, kEpsilon, 1.0);
  return {x, y, std::sqrt(x * y)};
}

OpenPbr::OpenPbr(const OpenPbrParameters& p) noexcept
    : p_(p),
      tangent_cos_(p.geometry_tangent == 90 ? 0 : std::cos(radians(p.geometry_tangent))),
      tangent_sin_(std::sin(radians(p.geometry_tangent))),
      metal_f0_(p.base_weight * p.base_color) {
  // a rough coat blurs what is seen through it
  const double rough4 = square(square(p.specular_roughness)), coat4 = square(square(p.coat_roughness));
  const double blurred = std::sqrt(std::sqrt(std::min(1.0, rough4 + 2 * coat4)));
  base_alpha_ = roughness(mix(p.specular_roughness, blurred, p.coat_weight), p.specular_roughness_anisotropy);
  coat_alpha_ = roughness(p.coat_roughness, p.coat_roughness_anisotropy);

  // index against air or coat, never below 1, then that of the weighted reflectance
  const double ratio = std::max(p.specular_ior / p.coat_ior, p.coat_ior / p.specular_ior);
  const double ior = mix(p.specular_ior, ratio, p.coat_weight);
  const double root = std::sqrt(std::clamp(p.specular_weight * reflectance_of_ior(ior), 0.0, 0.99999));
  base_ior_ = (1 + root) / (1 - root);

  // light reflected back and forth between base and coat
  const double inside = 1 - (1 - reflectance_of_ior(p.coat_ior)) / square(p.coat_ior);
  const Rgb base = mix(p.base_color, p.specular_weight * p.base_color, p.base_metalness);
  const Rgb darkening = each(base, [&](double albedo) { return (1 - inside) / (1 - albedo * inside); });
  under_coat_ = mix(1, darkening, p.coat_weight * p.coat_darkening) * mix(1, p.coat_color, p.coat_weight);
}

bool OpenPbr::isotropic() const noexcept {
  return base_alpha_.x == base_alpha_.y && (p_.coat_weight == 0 || coat_alpha_.x == coat_alpha_.y);
}

OpenPbr::PartSet OpenPbr::needed() const noexcept {
  PartSet parts;
  parts[film] = p_.thin_film_weight > 0 && p_.thin_film_thickness > 0;
  parts[facets] = parts[coating] = parts[fuzz] = true;
  parts[base_diffuse] = parts[gloss] = p_.base_metalness < 1;
  parts[metal] = p_.base_metalness > 0;
  return parts;
}

/// Returns the parts that the other's cannot serve.
OpenPbr::PartSet OpenPbr::needed_beside(const OpenPbr& other) const noexcept {
  const auto differ = [&](auto... members) { return (... || (p_.*members != other.p_.*members)); };
  using P = OpenPbrParameters;
  PartSet parts;
  parts[film] = differ(&P::thin_film_ior, &P::thin_film_thickness);
  parts[facets] = base_alpha_ != other.base_alpha_;
  parts[base_diffuse] = differ(&P::base_weight, &P::base_color, &P::base_diffuse_roughness);
  const bool lit = parts[film] || parts[facets] || differ(&P::thin_film_weight, &P::specular_color);
  parts[gloss] = lit || base_ior_ != other.base_ior_;
  parts[metal] = lit || metal_f0_ != other.metal_f0_ || differ(&P::specular_weight);
  parts[coating] = coat_alpha_ != other.coat_alpha_ || differ(&P::coat_weight, &P::coat_ior);
  parts[fuzz] = differ(&P::fuzz_weight, &P::fuzz_color, &P::fuzz_roughness);
  return needed() & (parts | ~other.needed());
}
namespace {

void put(Rgb value, std::span<double> f) noexcept {
  f[0] = value.r;
  f[1] = value.g;
  f[2] = value.b;
}

}  // namespace

bool OpenPbr::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) {
    f[0] = f[1] = f[2] = 0;
    return true;
  }
  const Geometry<double> g(wi, wo, *this);
  Parts<double> parts;
  compute(needed(), g, parts);
  put(join(parts), f);
  return true;
}

OpenPbrVariants::OpenPbrVariants(const OpenPbr& material, std::vector<OpenPbr> others)
    : material_(material), others_(std::move(others)) {
  for (const OpenPbr& other : others_) fresh_.push_back(other.needed_beside(material_));
}

void OpenPbrVariants::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) {
    std::ranges::fill(f, 0.0);
    return;
  }
  const OpenPbr::Geometry<double> g(wi, wo, material_);
  OpenPbr::Parts<double> parts;
  material_.compute(material_.needed(), g, parts);
  put(material_.join(parts), f.first(3));
  for (std::size_t i = 0; i < others_.size(); ++i) {
    OpenPbr::Parts<double> own = parts;
    others_[i].compute(fresh_[i], g, own);
    put(others_[i].join(own), f.subspan(3 * (i + 1), 3));
  }
}

}  // namespace burnish
