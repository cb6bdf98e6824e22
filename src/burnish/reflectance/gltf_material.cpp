// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/reflectance/analytic/film_response.h>
#include <burnish/reflectance/analytic/microfacet.h>
#include <burnish/reflectance/gltf_material.h>

namespace burnish {

namespace {

constexpr double square(double x) noexcept {
  return x * x;
}
constexpr Rgb mix(Rgb at_0, Rgb at_1, double t) noexcept {
  return (1 - t) * at_0 + t * at_1;
}
double greatest(Rgb c) noexcept {
  return std::max({c.r, c.g, c.b});
}
double reflectance_between(double ior, double other) noexcept {
  return square((ior - other) / (ior + other));
}
double schlick(double f0, double cosine) noexcept {
  return fresnel_schlick(f0, cosine).r;
}

/// Returns what an order of interference of unit amplitude adds: X, Y and Z turned by the phases of the base's
/// channels, as the text has it, in linear Rec. 709.
std::array<double, 3> interference(double phase, const std::array<double, 3>& turned) noexcept {
  std::array<double, 3> xyz{};
  for (const auto& [i, value, position, variance] : kFilmResponses)
    xyz[i] += value * std::sqrt(kTwoPi * variance) / kFilmNorm * std::cos(position * phase + turned[i]) *
              std::exp(-variance * square(phase));
  const auto row = [&](double x, double y, double z) { return 2 * (x * xyz[0] + y * xyz[1] + z * xyz[2]); };
  return {row(3.2404542, -1.5371385, -0.4985314), row(-0.9692660, 1.8760108, 0.0415560),
          row(0.0556434, -0.2040259, 1.0572252)};
}

/// Reflectance of a film in air on what reflects f0 at normal incidence, at most 1: KHR_materials_iridescence,
/// "Iridescence Fresnel".
Rgb iridescent_fresnel(double film_ior, double nanometres, Rgb base_f0, double cosine) noexcept {
  constexpr double kGuard = 1e-4, kMinRatio = 1e-5, kMaxRatio = 0.9999;  // the text's
  const double cos_inside = std::sqrt(1 - (1 - square(cosine)) / square(film_ior));
  const double phase = kTwoPi * 1e-9 * 2 * film_ior * nanometres * cos_inside;
  const double upper = schlick(reflectance_between(film_ior, 1), cosine), through = 1 - upper;

  // the lower face, a channel of the base at a time
  const std::array f0 = {base_f0.r, base_f0.g, base_f0.b};
  std::array<double, 3> turned, ratio, sum, amplitude;
  for (std::size_t c = 0; c < 3; ++c) {
    const double root = std::sqrt(std::min(f0[c] + kGuard, kMaxRatio)), ior = (1 + root) / (1 - root);
    const double lower = schlick(reflectance_between(ior, film_ior), cos_inside);
    const double both = std::clamp(upper * lower, kMinRatio, kMaxRatio);
    const double returned = square(through) * lower / (1 - both);
    turned[c] =
        ior < film_ior ? kTwoPi : kPi;  // pi at the upper face from within, and at a lower of less index
    ratio[c] = std::sqrt(both);
    sum[c] = upper + returned;
    amplitude[c] = returned - through;
  }

  // both orders
  for (int m = 1; m <= 2; ++m) {
    const std::array<double, 3> seen = interference(m * phase, {m * turned[0], m * turned[1], m * turned[2]});
    for (std::size_t c = 0; c < 3; ++c) {
      amplitude[c] *= ratio[c];
      sum[c] += amplitude[c] * seen[c];
    }
  }
  for (double& x : sum) x = std::clamp(x, 0.0, 1.0);
  return {sum[0], sum[1], sum[2]};
}

/// exp of this is the Lambda of sheen's masking [Estevez 2017], between grazing and 60 degrees.
double log_lambda(double x, double alpha) noexcept {
  const double t = square(1 - alpha);
  const double a = std::lerp(21.5473, 25.3245, t), b = std::lerp(3.82987, 3.32435, t),
               c = std::lerp(0.19823, 0.16801, t), d = std::lerp(-1.97760, -1.27393, t),
               e = std::lerp(-4.32054, -4.85967, t);
  return a / (1 + b * std::pow(x, c)) + d * x + e;
}

double sheen_lambda(double cosine, double alpha) noexcept {
  return std::exp(cosine < 0.5 ? log_lambda(cosine, alpha)
                               : 2 * log_lambda(0.5, alpha) - log_lambda(1 - cosine, alpha));
}

/// f_r of sheen whose colour is 1.
double sheen(double cos_i, double cos_o, double cos_h, double roughness) noexcept {
  const double alpha = square(roughness), sin2 = std::max(1 - square(cos_h), 0.0);
  const double density = (2 + 1 / alpha) * std::pow(sin2, 0.5 / alpha) / kTwoPi;
  const double masked = 1 + sheen_lambda(cos_i, alpha) + sheen_lambda(cos_o, alpha);
  return density / (masked * 4 * cos_i * cos_o);
}

/// Albedos of sheen at even roots of the cosine and even roughnesses.
class SheenAlbedos {
 public:
  static constexpr int kCosines = 32, kRoughnesses = 24;
  static constexpr double kMinRoughness = 0.07;

  SheenAlbedos() noexcept {
    for (int r = 0; r <= kRoughnesses; ++r)
      for (int c = 0; c <= kCosines; ++c)
        at(r, c) = integral(square(static_cast<double>(std::max(c, 1)) / kCosines),
                            kMinRoughness + (1 - kMinRoughness) * r / kRoughnesses);
  }

  double operator()(double cosine, double roughness) const noexcept {
    const double x = std::sqrt(cosine) * kCosines,
                 y = (roughness - kMinRoughness) / (1 - kMinRoughness) * kRoughnesses;
    const int c = std::clamp(static_cast<int>(x), 0, kCosines - 1),
              r = std::clamp(static_cast<int>(y), 0, kRoughnesses - 1);
    const double u = x - c, v = y - r;
    return std::lerp(std::lerp(at(r, c), at(r, c + 1), u), std::lerp(at(r + 1, c), at(r + 1, c + 1), u), v);
  }

 private:
  double& at(int r, int c) noexcept { return values_[static_cast<std::size_t>(r * (kCosines + 1) + c)]; }
  double at(int r, int c) const noexcept { return values_[static_cast<std::size_t>(r * (kCosines + 1) + c)]; }

  /// Midpoints of even azimuths and of cosines that crowd at the horizon.
  static double integral(double cos_o, double roughness) noexcept {
    constexpr int kSteps = 24;
    const double sin_o = std::sqrt(1 - square(cos_o));
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double u = (i + 0.5) / kSteps, cos_i = square(u), sin_i = std::sqrt(1 - square(cos_i));
      for (int j = 0; j < kSteps; ++j) {
        const double between = std::cos(kPi * (j + 0.5) / kSteps) * sin_i * sin_o + cos_i * cos_o;
        const double cos_h = std::min((cos_i + cos_o) / std::sqrt(2 + 2 * between), 1.0);
        sum += sheen(cos_i, cos_o, cos_h, roughness) * cos_i * 2 * u;
      }
    }
    return std::min(sum * kTwoPi / square(kSteps), 1.0);
  }

  std::array<double, (kCosines + 1) * (kRoughnesses + 1)> values_;
};

}  // namespace

bool GltfMaterial::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  if (rotation != 0) {
    const double c = std::cos(rotation), s = std::sin(rotation);
    wi = {c * wi.x + s * wi.y, c * wi.y - s * wi.x, wi.z};
    wo = {c * wo.x + s * wo.y, c * wo.y - s * wo.x, wo.z};
  }
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry& g) {
    // highlights of the base
    const double alpha = square(roughness), stretched = alpha + (1 - alpha) * square(anisotropy);
    const double base = facets(GgxDistribution{stretched, alpha}, g);
    const auto under_film = [&](Rgb fresnel, Rgb f0) {
      return iridescence > 0
                 ? mix(fresnel, iridescent_fresnel(iridescence_ior, iridescence_thickness, f0, g.cos_d),
                       iridescence)
                 : fresnel;
    };

    // a mixture of dielectric and metal
    Rgb f0 = reflectance_between(ior, 1) * specular_color;
    f0 = {std::min(f0.r, 1.0), std::min(f0.g, 1.0), std::min(f0.b, 1.0)};
    const Rgb gloss = under_film(specular * fresnel_schlick(f0, g.cos_d), specular * f0);
    const Rgb dielectric = (1 - greatest(gloss)) * diffuse(base_color) + base * gloss;
    const Rgb metal = base * under_film(fresnel_schlick(base_color, g.cos_d), base_color);
    Rgb value = mix(dielectric, metal, metallic);

    // sheen over it
    if (const double most = greatest(sheen_color); most > 0) {
      const double albedo =
          std::max(sheen_albedo(g.cos_i, sheen_roughness), sheen_albedo(g.cos_o, sheen_roughness));
      value = sheen(g.cos_i, g.cos_o, g.h.z, sheen_roughness) * sheen_color + (1 - most * albedo) * value;
    }

    // and a coat over all
    if (clearcoat > 0) {
      const double coat = square(clearcoat_roughness);
      value = mix(value, facets(GgxDistribution{coat, coat}, g),
                  clearcoat * schlick(reflectance_between(1.5, 1), g.cos_o));
    }
    return value;
  });
}

double sheen_albedo(double cosine, double roughness) noexcept {
  static const SheenAlbedos albedos;
  return albedos(cosine, roughness);
}

}  // namespace burnish
