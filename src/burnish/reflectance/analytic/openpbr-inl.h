// SPDX-License-Identifier: Apache-2.0
#pragma once

// The formulas of OpenPbr for a number type T: double, the definition, or Expr. Two files instantiate them, one each,
// so that expression graphs, which run once a material, are compiled apart from evaluation.

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include <burnish/formula/expression.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/analytic/film_response.h>
#include <burnish/reflectance/analytic/openpbr.h>

namespace burnish {

namespace openpbr_formulas {

// Least cosine, roughness and loss, as MaterialX has it.
inline constexpr double kEpsilon = 1e-8;

// The formulas need these functions of T. Parameters are doubles in both cases.

using std::acos;
using std::clamp;
using std::cos;
using std::exp;
using std::max;
using std::sqrt;

inline double named(const char*, double x) noexcept {
  return x;
}
inline double if_less(double a, double b, double x, double y) noexcept {
  return a < b ? x : y;
}
inline Expr clamp(const Expr& x, double low, double high) {
  return min(max(x, low), high);
}
inline double length(double x, double y) noexcept {
  return std::hypot(x, y);
}
inline Expr length(const Expr& x, const Expr& y) {
  return sqrt(x * x + y * y);
}
inline ExprVector half_vector(const ExprVector& wi, const ExprVector& wo) {
  const ExprVector sum = named("sum", wi + wo);
  return named("h", named("inverse", 1 / sqrt(dot(sum, sum))) * sum);
}

struct ExprColor {
  Expr r, g, b;

  ExprColor() = default;
  ExprColor(Expr red, Expr green, Expr blue) : r(std::move(red)), g(std::move(green)), b(std::move(blue)) {}
  ExprColor(const Expr& grey) : ExprColor(grey, grey, grey) {}           // NOLINT: as Rgb
  ExprColor(double grey) : ExprColor(Expr(grey)) {}                      // NOLINT: likewise
  ExprColor(const Rgb& color) : ExprColor(color.r, color.g, color.b) {}  // NOLINT: of constants

  friend ExprColor operator+(const ExprColor& p, const ExprColor& q) {
    return {p.r + q.r, p.g + q.g, p.b + q.b};
  }
  friend ExprColor operator*(const ExprColor& p, const ExprColor& q) {
    return {p.r * q.r, p.g * q.g, p.b * q.b};
  }
};

template <class T>
using Color = std::conditional_t<std::is_same_v<T, double>, Rgb, ExprColor>;
template <class T>
using Vector = std::conditional_t<std::is_same_v<T, double>, Vec3, ExprVector>;

template <class T>
constexpr T square(const T& x) {
  return x * x;
}
template <class T>
constexpr T fifth_power(const T& x) {
  return square(square(x)) * x;
}
template <class T>
constexpr T mix(double at_0, double at_1, const T& t) {
  return at_0 + t * (at_1 - at_0);
}
constexpr Rgb mix(Rgb at_0, Rgb at_1, double t) noexcept {
  return at_0 + t * (at_1 + -1.0 * at_0);
}
inline ExprColor mix(const ExprColor& at_0, const ExprColor& at_1, double t) {
  return at_0 + t * (at_1 + -1.0 * at_0);
}
template <class Function>
constexpr auto each(Rgb x, const Function& function) {
  return Color<decltype(function(x.r))>(function(x.r), function(x.g), function(x.b));
}

/// Sums of 1, x, y, x y, x^2, y^2, x^2 y, x y^2 and x^2 y^2 with weights: a function of these.
inline auto biquadratic(double x, double y) noexcept {
  const std::array terms{1.0, x, y, x * y, x * x, y * y, x * x * y, x * y * y, x * x * y * y};
  return [terms](const double(&weights)[9]) {
    double total = 0;
    for (std::size_t i = 0; i < 9; ++i) total += weights[i] * terms[i];
    return total;
  };
}
/// Returns the same for a number y, whose terms are computed at once.
inline auto biquadratic(const Expr& x, double y) {
  return [x, y](const double(&w)[9]) {
    const auto of_y = [y](double a, double b, double c) { return a + b * y + c * y * y; };
    return mul_add(mul_add(x, of_y(w[4], w[6], w[8]), of_y(w[1], w[3], w[7])), x, of_y(w[0], w[2], w[5]));
  };
}

inline double reflectance_of_ior(double ior) noexcept {
  return square((ior - 1) / (ior + 1));
}

/// Returns the reflectance of a dielectric for unpolarized light. Domain: cosine in (0, 1], ior >= 1.
template <class T>
T fresnel(const T& cosine, double ior) {
  const T c = cosine, g = named("g", sqrt(ior * ior + c * c - 1));
  return 0.5 * square((g - c) / (g + c)) * (1 + square(((g + c) * c - 1) / ((g - c) * c + 1)));
}

/// Directional albedo of GGX facets whose Fresnel factor is f0 + (1 - f0) (1 - cos)^5: f0 scale + bias.
/// Rational fit of MaterialX to simulated values. Domain: cosine and alpha in [0, 1].
template <class T>
struct FacetAlbedo {
  T scale = 0.0, bias = 0.0;

  FacetAlbedo() = default;
  FacetAlbedo(const T& cosine, double alpha) {
    const auto sum = biquadratic(cosine, alpha);
    // clang-format off
    static constexpr double kScale[] =        {0.1003, -0.6303, 9.748, -2.038, 29.34, -8.245, -26.44, 19.99, -5.448};
    static constexpr double kScaleDivisor[] = {1, -1.765, 8.263, 11.53, 28.96, -7.507, -36.11, 15.86, 33.37};
    static constexpr double kBias[] =         {0.9345, -2.323, 2.229, -3.748, 1.424, -0.7684, 1.436, 0.2913, 0.6286};
    static constexpr double kBiasDivisor[] =  {1, 0.2281, 15.94, -55.83, 13.08, 41.26, 54.9, 300.2, -285.1};
    // clang-format on
    scale = named("scale", clamp(sum(kScale) / sum(kScaleDivisor), 0.0, 1.0));
    bias = named("bias", clamp(sum(kBias) / sum(kBiasDivisor), 0.0, 1.0));
  }
};

// The following is the thin film of [Belcour 2017].

/// Reflectance of the two polarizations.
template <class T>
struct Polarized {
  T p, s;
};

template <class T>
Polarized<T> fresnel_polarized(const T& cosine, double ior) {
  const T cos2 = square(cosine), sin2 = 1 - cos2;
  const T t0 = max(ior * ior - sin2, T(0.0)), t1 = t0 + cos2, t2 = 2 * sqrt(t0) * cosine;
  const T s = (t1 - t2) / (t1 + t2);
  const T t3 = cos2 * t0 + sin2 * sin2, t4 = t2 * sin2;
  return {s * (t3 - t4) / (t3 + t4), s};
}

/// Light in a film: its index of refraction, the cosine inside, and what X, Y and Z see of both orders of interference,
/// for phases that do not turn.
template <class T>
struct Film {
  double ior = 1;
  T cos_inside = 1.0;
  std::array<std::array<T, 3>, 2> response{};

  Film() = default;
  Film(double film_ior, double micrometres, const T& cosine)
      : ior(film_ior), cos_inside(named("inside", sqrt(1 - (1 - square(cosine)) / square(film_ior)))) {
    // of the first order; the second has twice the phase
    const T phase = named("phase", kTwoPi * 2 * ior * cos_inside * 1e-6 * micrometres);
    for (const auto& [i, value, position, variance] : kFilmResponses) {
      const double height = value * std::sqrt(kTwoPi * variance) / kFilmNorm;
      const T wave = named("wave", cos(position * phase)),
              decay = named("decay", exp(-variance * phase * phase));
      response[0][i] = response[0][i] + height * decay * wave;
      response[1][i] = response[1][i] + height * square(square(decay)) * (2 * wave * wave - 1);
    }
  }
};

/// The film's lower face in one polarization, one a response: reflectance, and -1 where the phase turns by pi, else 1.
template <class T>
struct LowerFace {
  std::array<T, 3> reflectance, sign;
};

/// Adds one polarization's share of the film's reflectance (X, Y, Z) [Belcour 2017, eq. 3, 7]. `upper` and
/// `upper_sign` are the upper face's.
template <class T>
void add_airy(const Film<T>& film, const T& upper, const T& upper_sign, const LowerFace<T>& lower,
              std::array<T, 3>& sum) {
  for (std::size_t i = 0; i < 3; ++i) {
    const T both = upper * lower.reflectance[i];
    const T through = square(1 - upper) * lower.reflectance[i] / (1 - both);
    const T ratio = sqrt(max(both, T(0.0))) * (lower.sign[i] * upper_sign);
    sum[i] = sum[i] + (upper + through);
    T amplitude = through - (1 - upper);
    for (const std::array<T, 3>& response : film.response) {
      amplitude = amplitude * ratio;
      sum[i] = sum[i] + 2 * amplitude * response[i];
    }
  }
}

/// Reflectance of a film in air, from its lower face in both polarizations.
template <class T>
Color<T> fresnel_airy(const T& cosine, const Film<T>& film, const LowerFace<T>& lower_p,
                      const LowerFace<T>& lower_s) {
  const T none(0.0), one(1.0), turned(-1.0);
  const Polarized<T> upper = fresnel_polarized(cosine, film.ior);
  const double cos_brewster = 1 / std::sqrt(1 + square(film.ior));
  std::array<T, 3> xyz{};
  const auto add = [&](const T& reflectance, const T& sign, const LowerFace<T>& lower) {
    add_airy(film, named("upper", if_less(none, film.cos_inside, reflectance, one)), sign, lower, xyz);
  };
  add(upper.p, if_less(cosine, T(cos_brewster), one, turned), lower_p);
  add(upper.s, turned, lower_s);
  const auto row = [&](double x, double y, double z) {
    return clamp(0.5 * (x * xyz[0] + y * xyz[1] + z * xyz[2]), 0.0, 1.0);
  };
  // XYZ of equal energy to CIE RGB, as the paper's code has it
  return {row(2.3706743, -0.9000405, -0.4706338), row(-0.5138850, 1.4253036, 0.0885814),
          row(0.0052982, -0.0146949, 1.0093968)};
}

/// Directional and mean albedo of the single-scattering Fujii lobe of albedo 1. Source: [OpenPBR 2024].
inline constexpr double kFujii1 = 0.5 - 2 / (3 * kPi), kFujii2 = 2.0 / 3 - 28 / (15 * kPi);

template <class T>
T fujii_albedo(const T& cosine, double roughness) {
  const T sine = named("sine", sqrt(max(T(0.0), 1 - square(cosine))));
  const T g =
      sine * (acos(cosine) - sine * cosine) + 2 * ((sine / cosine) * (1 - sine * sine * sine) - sine) / 3;
  return (1 + roughness * g / kPi) / (1 + kFujii1 * roughness);
}

/// Returns 1 - albedo, at least kEpsilon.
template <class T>
T lost(const T& albedo) {
  return max(T(kEpsilon), 1 - albedo);
}

}  // namespace openpbr_formulas

using namespace openpbr_formulas;  // NOLINT: this header is no public one

/// Cosines as MaterialX bounds them, of light, viewer, half angle and between the two.
template <class T>
struct OpenPbr::Geometry {
  Vector<T> wi, wo, h;
  T cos_i, cos_o, cos_d, cos_between;

  Geometry(const Vector<T>& to_light, const Vector<T>& to_viewer, const OpenPbr& material)
      : wi(material.in_tangent_frame(to_light)),
        wo(material.in_tangent_frame(to_viewer)),
        h(half_vector(wi, wo)),
        cos_i(named("cos_i", clamp(wi.z, kEpsilon, 1.0))),
        cos_o(named("cos_o", clamp(wo.z, kEpsilon, 1.0))),
        cos_d(named("cos_d", clamp(dot(wo, h), kEpsilon, 1.0))),
        cos_between(clamp(dot(wi, wo), kEpsilon, 1.0)) {}
};

/// f_r of a layer, 1/sr, and the share of what lies below that it lets through.
template <class T>
struct OpenPbr::Layer {
  Color<T> reflected;
  Color<T> transmitted = 1;

  Color<T> over(const Color<T>& below) const { return reflected + transmitted * below; }
};

/// Facets without their Fresnel factor: D G / (4 cos_i cos_o) and albedos towards the viewer.
template <class T>
struct OpenPbr::Highlight {
  T value = 0.0;
  FacetAlbedo<T> albedo;

  /// Returns the factor by which multiple reflections between facets restore energy [Turquin 2019, eq. 14, 16].
  Color<T> compensation(const Color<T>& fresnel) const {
    const T single = albedo.scale + albedo.bias;
    return 1 + (1 - single) / single * fresnel;
  }
};

/// One of each Part.
template <class T>
struct OpenPbr::Parts {
  Film<T> film;
  Highlight<T> facets;
  Color<T> diffuse, metal;
  Layer<T> gloss, coating, fuzz;
};
template <class V>
V OpenPbr::in_tangent_frame(const V& w) const {
  if (p_.geometry_tangent == 0) return w;
  return V{tangent_cos_ * w.x + tangent_sin_ * w.y, tangent_cos_ * w.y - tangent_sin_ * w.x, w.z};
}

template <class T>
OpenPbr::Highlight<T> OpenPbr::highlight(const Roughness& alpha, const Geometry<T>& g) const {
  const T d = named("d", square(g.h.x / alpha.x) + square(g.h.y / alpha.y) + square(g.h.z));
  const T density = named("density", 1 / (kPi * alpha.x * alpha.y * d * d));
  // [Heitz 2014, eq. 72, 99], isotropic with the mean roughness
  const double alpha2 = square(alpha.mean);
  const auto stretched = [&](const T& cosine) { return sqrt(alpha2 + (1 - alpha2) * square(cosine)); };
  const T visibility = 0.5 / (stretched(g.cos_i) * g.cos_o + stretched(g.cos_o) * g.cos_i);
  return {named("facets", density * visibility), FacetAlbedo<T>(g.cos_o, alpha.mean)};
}

template <class T>
auto OpenPbr::dielectric_under_film(const Parts<T>& parts, const Geometry<T>& g) const {
  const Film<T>& under = parts.film;
  const Polarized<T> lower = fresnel_polarized(under.cos_inside, base_ior_ / under.ior);
  // Phases turn by pi at the denser side; parallel ones not beyond Brewster's angle.
  const double base2 = square(base_ior_), film2 = square(under.ior);
  const T cos2 = square(under.cos_inside), beyond = base2 - film2 * (1 - cos2);
  const T sign_p = if_less(base2 * base2 * cos2, film2 * beyond, T(-1.0), T(1.0)),
          sign_s = base2 < film2 ? -1.0 : 1.0;
  return fresnel_airy<T>(g.cos_d, under, {{lower.p, lower.p, lower.p}, {sign_p, sign_p, sign_p}},
                         {{lower.s, lower.s, lower.s}, {sign_s, sign_s, sign_s}});
}

template <class T>
auto OpenPbr::metal_fresnel(const T& cosine) const {
  constexpr double kCos82 = 1.0 / 7, kSin = 1 - kCos82;
  constexpr double kFactor = 1 / (kCos82 * kSin * fifth_power(kSin));
  const T grazing = named("grazing", fifth_power(1 - cosine)),
          dip = named("dip", cosine * (1 - cosine) * grazing * kFactor);
  const auto channel = [&](double f0, double f82) {
    return mix(f0, 1, grazing) - mix(f0, 1, fifth_power(kSin)) * (1 - f82) * dip;
  };
  return Color<T>(channel(metal_f0_.r, p_.specular_color.r), channel(metal_f0_.g, p_.specular_color.g),
                  channel(metal_f0_.b, p_.specular_color.b));
}

template <class T>
auto OpenPbr::metal_under_film(const Parts<T>& parts, const Geometry<T>& g) const {
  const Film<T>& under = parts.film;
  const Color<T> half = 0.5 * metal_fresnel(under.cos_inside);
  const auto sign = [&](double f0) {
    const double root = std::sqrt(std::clamp(f0, 0.01, 0.99));
    return T((1 + root) / (1 - root) < under.ior ? -1.0 : 1.0);
  };
  const LowerFace<T> face{{half.r, half.g, half.b},
                          {sign(metal_f0_.r), sign(metal_f0_.g), sign(metal_f0_.b)}};
  return fresnel_airy<T>(g.cos_d, under, face, face);
}

template <class T>
auto OpenPbr::diffuse_base(const Geometry<T>& g) const {
  const double rough = p_.base_diffuse_roughness, single = 1 / (1 + kFujii1 * rough);
  const T s = named("s", g.cos_between - g.cos_i * g.cos_o);
  const T lobe = single * (1 + rough * if_less(T(0.0), s, s / max(g.cos_i, g.cos_o), s));
  // light reflected more than once
  const double mean_albedo = single * (1 + kFujii2 * rough);
  const T multiple = rough == 0 ? T(kEpsilon)  // nothing is lost
                                : lost(fujii_albedo(g.cos_i, rough)) * lost(fujii_albedo(g.cos_o, rough)) /
                                      lost(mean_albedo);
  return each(p_.base_color, [&](double color) {
    const double again = square(color) * mean_albedo / (1 - color * std::max(0.0, 1 - mean_albedo));
    return p_.base_weight / kPi * (color * lobe + again * multiple);
  });
}

template <class T>
OpenPbr::Layer<T> OpenPbr::gloss_layer(const Parts<T>& parts, const Geometry<T>& g) const {
  const Highlight<T>& peak = parts.facets;
  const double f0 = reflectance_of_ior(base_ior_);
  const T albedo = f0 * peak.albedo.scale + peak.albedo.bias;
  Layer<T> layer{.reflected = 0, .transmitted = 1};
  const auto add = [&](const Color<T>& fresnel, double weight) {
    const Color<T> compensation = peak.compensation(fresnel);
    layer.reflected = layer.reflected + weight * peak.value * fresnel * compensation * p_.specular_color;
    layer.transmitted = layer.transmitted + -weight * albedo * compensation;
  };
  if (p_.thin_film_weight < 1) add(fresnel(g.cos_d, base_ior_), 1 - p_.thin_film_weight);
  if (p_.thin_film_weight > 0)
    add(p_.thin_film_thickness > 0 ? dielectric_under_film(parts, g) : Color<T>(fresnel(g.cos_d, base_ior_)),
        p_.thin_film_weight);
  return layer;
}

template <class T>
auto OpenPbr::metal_base(const Parts<T>& parts, const Geometry<T>& g) const {
  const Highlight<T>& peak = parts.facets;
  Color<T> sum;
  const auto add = [&](const Color<T>& fresnel, double weight) {
    sum = sum + p_.specular_weight * weight * peak.value * fresnel * peak.compensation(fresnel);
  };
  if (p_.thin_film_weight < 1) add(metal_fresnel(g.cos_d), 1 - p_.thin_film_weight);
  if (p_.thin_film_weight > 0)
    add(p_.thin_film_thickness > 0 ? metal_under_film(parts, g) : metal_fresnel(g.cos_d),
        p_.thin_film_weight);
  return sum;
}

template <class T>
OpenPbr::Layer<T> OpenPbr::coat_layer(const Geometry<T>& g) const {
  if (p_.coat_weight == 0) return {};
  const Highlight<T> peak = highlight(coat_alpha_, g);
  const T reflectance = fresnel(g.cos_d, p_.coat_ior);
  const T compensation = peak.compensation(reflectance).r;
  const T albedo = reflectance_of_ior(p_.coat_ior) * peak.albedo.scale + peak.albedo.bias;
  return {p_.coat_weight * peak.value * reflectance * compensation,
          1 - p_.coat_weight * albedo * compensation};
}

template <class T>
OpenPbr::Layer<T> OpenPbr::fuzz_layer(const Geometry<T>& g) const {
  if (p_.fuzz_weight == 0) return {};
  const T x = g.cos_o;
  const double y = std::clamp(p_.fuzz_roughness, 0.01, 1.0);
  // albedo and matrix as MaterialX fits the tables of [Zeltner 2022]
  const double width = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
  const double middle = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
  const double offset = y * (0.000654023 + (-0.0207818 + 0.119681 * y) * y) / (1.26264 + y * (-1.92021 + y));
  const T albedo = exp(-0.5 * square((x - middle) / width)) / (width * std::sqrt(kTwoPi)) + offset;
  const T a = (2.58126 * x + 0.813703 * y) * y / (1 + 0.310327 * x * x + 2.60994 * x * y);
  const T b =
      sqrt(1 - x) * (y - 1) * y * y * y / (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
  // wi in the frame where wo has no y
  const T none(0.0), sine = length(g.wo.x, g.wo.y);
  const T along = if_less(none, sine, (g.wi.x * g.wo.x + g.wi.y * g.wo.y) / sine, g.wi.x);
  const T across = if_less(none, sine, (g.wo.x * g.wi.y - g.wo.y * g.wi.x) / sine, g.wi.y);
  const T length2 = square(a * along + b * g.wi.z) + square(a * across) + square(g.wi.z);
  const T value = p_.fuzz_weight * albedo * square(a / length2) / kPi;
  return {value * Color<T>(p_.fuzz_color), 1 - p_.fuzz_weight * albedo};
}

template <class T>
void OpenPbr::compute(const PartSet& which, const Geometry<T>& g, Parts<T>& parts) const {
  if (which[film]) parts.film = Film<T>(p_.thin_film_ior, p_.thin_film_thickness, g.cos_d);
  if (which[facets]) parts.facets = highlight(base_alpha_, g);
  if (which[base_diffuse]) parts.diffuse = diffuse_base(g);
  if (which[gloss]) parts.gloss = gloss_layer(parts, g);
  if (which[metal]) parts.metal = metal_base(parts, g);
  if (which[coating]) parts.coating = coat_layer(g);
  if (which[fuzz]) parts.fuzz = fuzz_layer(g);
}

template <class T>
auto OpenPbr::join(const Parts<T>& parts) const {
  using C = Color<T>;
  const C dielectric = p_.base_metalness < 1 ? parts.gloss.over(parts.diffuse) : C();
  const C base = mix(dielectric, p_.base_metalness > 0 ? parts.metal : C(), p_.base_metalness);
  const C value = parts.fuzz.over(parts.coating.over(under_coat_ * base));
  const T none(0.0);
  return C(max(value.r, none), max(value.g, none), max(value.b, none));
}

}  // namespace burnish
