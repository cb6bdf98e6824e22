#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <burnish/math/angles.h>
#include <burnish/reflectance/analytic/openpbr.h>

namespace burnish {

namespace {

// Least cosine, roughness and loss, as MaterialX has it.
constexpr double kEpsilon = 1e-8;

constexpr double square(double x) noexcept {
  return x * x;
}
constexpr double fifth_power(double x) noexcept {
  return square(square(x)) * x;
}
constexpr double mix(double at_0, double at_1, double t) noexcept {
  return at_0 + t * (at_1 - at_0);
}
constexpr Rgb mix(Rgb at_0, Rgb at_1, double t) noexcept {
  return at_0 + t * (at_1 + -1.0 * at_0);
}
template <class Function>
constexpr Rgb each(Rgb x, const Function& function) noexcept {
  return {function(x.r), function(x.g), function(x.b)};
}

double reflectance_of_ior(double ior) noexcept {
  return square((ior - 1) / (ior + 1));
}

/// Of a dielectric, for unpolarized light. Domain: cosine in (0, 1], ior >= 1.
double fresnel(double cosine, double ior) noexcept {
  const double c = cosine, g = std::sqrt(ior * ior + c * c - 1);
  return 0.5 * square((g - c) / (g + c)) * (1 + square(((g + c) * c - 1) / ((g - c) * c + 1)));
}

/// Directional albedo of GGX facets whose Fresnel factor is f0 + (1 - f0) (1 - cos)^5: f0 scale + bias.
/// Rational fit of MaterialX to simulated values. Domain: cosine and alpha in [0, 1].
struct FacetAlbedo {
  double scale = 0, bias = 0;

  FacetAlbedo() = default;
  FacetAlbedo(double cosine, double alpha) noexcept {
    const double x = cosine, y = alpha;
    const double terms[] = {1, x, y, x * y, x * x, y * y, x * x * y, x * y * y, x * x * y * y};
    const auto sum = [&](const double(&weights)[9]) {
      double total = 0;
      for (int i = 0; i < 9; ++i) total += weights[i] * terms[i];
      return total;
    };
    // clang-format off
    static constexpr double kScale[] =        {0.1003, -0.6303, 9.748, -2.038, 29.34, -8.245, -26.44, 19.99, -5.448};
    static constexpr double kScaleDivisor[] = {1, -1.765, 8.263, 11.53, 28.96, -7.507, -36.11, 15.86, 33.37};
    static constexpr double kBias[] =         {0.9345, -2.323, 2.229, -3.748, 1.424, -0.7684, 1.436, 0.2913, 0.6286};
    static constexpr double kBiasDivisor[] =  {1, 0.2281, 15.94, -55.83, 13.08, 41.26, 54.9, 300.2, -285.1};
    // clang-format on
    scale = std::clamp(sum(kScale) / sum(kScaleDivisor), 0.0, 1.0);
    bias = std::clamp(sum(kBias) / sum(kBiasDivisor), 0.0, 1.0);
  }
};

// What follows is the thin film of [Belcour 2017].

/// Reflectance of the two polarizations.
struct Polarized {
  double p, s;
};

Polarized fresnel_polarized(double cosine, double ior) noexcept {
  const double cos2 = square(cosine), sin2 = 1 - cos2;
  const double t0 = std::max(ior * ior - sin2, 0.0), t1 = t0 + cos2, t2 = 2 * std::sqrt(t0) * cosine;
  const double s = (t1 - t2) / (t1 + t2);
  const double t3 = cos2 * t0 + sin2 * sin2, t4 = t2 * sin2;
  return {s * (t3 - t4) / (t3 + t4), s};
}

/// Light in a film: its index of refraction, the cosine inside, and what X, Y and Z see of both orders of interference,
/// for phases that do not turn. Gaussians in the Fourier domain, their constants those of the paper's code.
struct Film {
  double ior = 1, cos_inside = 1;
  std::array<std::array<double, 3>, 2> response{};

  Film() = default;
  Film(double film_ior, double micrometres, double cosine) noexcept
      : ior(film_ior), cos_inside(std::sqrt(1 - (1 - square(cosine)) / square(film_ior))) {
    // of the first order; the second has twice the phase
    constexpr double kNorm = 1.0685e-7;
    const double phase = kTwoPi * 2 * ior * cos_inside * 1e-6 * micrometres;
    const auto add = [&](std::size_t i, double value, double position, double variance) {
      const double height = value * std::sqrt(kTwoPi * variance) / kNorm;
      const double wave = std::cos(position * phase), decay = std::exp(-variance * phase * phase);
      response[0][i] += height * decay * wave;
      response[1][i] += height * square(square(decay)) * (2 * wave * wave - 1);
    };
    add(0, 5.4856e-13, 1.6810e6, 4.3278e9);
    add(0, 9.7470e-14, 2.2399e6, 4.5282e9);
    add(1, 4.4201e-13, 1.7953e6, 9.3046e9);
    add(2, 5.2481e-13, 2.2084e6, 6.6121e9);
  }
};

/// The film's lower face in one polarization, one a response: reflectance, and whether the phase turns by pi.
struct LowerFace {
  std::array<double, 3> reflectance;
  std::array<bool, 3> turns;
};

/// Adds one polarization's share of the film's reflectance (X, Y, Z) [Belcour 2017, eq. 3, 7]. `upper` and
/// `upper_turns` are the upper face's.
void add_airy(const Film& film, double upper, bool upper_turns, const LowerFace& lower,
              std::array<double, 3>& sum) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const double both = upper * lower.reflectance[i];
    const double through = square(1 - upper) * lower.reflectance[i] / (1 - both);
    const double ratio = std::sqrt(std::max(both, 0.0)) * (lower.turns[i] == upper_turns ? 1 : -1);
    sum[i] += upper + through;
    double amplitude = through - (1 - upper);
    for (const std::array<double, 3>& response : film.response) {
      amplitude *= ratio;
      sum[i] += 2 * amplitude * response[i];
    }
  }
}

/// Reflectance of a film in air, from its lower face in both polarizations.
Rgb fresnel_airy(double cosine, const Film& film, const LowerFace& lower_p,
                 const LowerFace& lower_s) noexcept {
  const Polarized upper = film.cos_inside > 0 ? fresnel_polarized(cosine, film.ior) : Polarized{1, 1};
  const double cos_brewster = 1 / std::sqrt(1 + square(film.ior));
  std::array<double, 3> xyz{};
  add_airy(film, upper.p, cosine >= cos_brewster, lower_p, xyz);
  add_airy(film, upper.s, true, lower_s, xyz);
  const auto row = [&](double x, double y, double z) {
    return std::clamp(0.5 * (x * xyz[0] + y * xyz[1] + z * xyz[2]), 0.0, 1.0);
  };
  // XYZ of equal energy to CIE RGB, as the paper's code has it
  return {row(2.3706743, -0.9000405, -0.4706338), row(-0.5138850, 1.4253036, 0.0885814),
          row(0.0052982, -0.0146949, 1.0093968)};
}

/// Directional and mean albedo of the single-scattering Fujii lobe of albedo 1. Source: [OpenPBR 2024].
constexpr double kFujii1 = 0.5 - 2 / (3 * kPi), kFujii2 = 2.0 / 3 - 28 / (15 * kPi);

double fujii_albedo(double cosine, double roughness) noexcept {
  const double sine = std::sqrt(std::max(0.0, 1 - square(cosine)));
  const double g = sine * (std::acos(cosine) - sine * cosine) +
                   2 * ((sine / cosine) * (1 - sine * sine * sine) - sine) / 3;
  return (1 + roughness * g / kPi) / (1 + kFujii1 * roughness);
}

}  // namespace

/// Cosines as MaterialX bounds them, of light, viewer, half angle and between the two.
struct OpenPbr::Geometry {
  Vec3 wi, wo, h;
  double cos_i, cos_o, cos_d, cos_between;

  Geometry(Vec3 to_light, Vec3 to_viewer) noexcept
      : wi(to_light),
        wo(to_viewer),
        h(half_vector(wi, wo)),
        cos_i(std::clamp(wi.z, kEpsilon, 1.0)),
        cos_o(std::clamp(wo.z, kEpsilon, 1.0)),
        cos_d(std::clamp(dot(wo, h), kEpsilon, 1.0)),
        cos_between(std::clamp(dot(wi, wo), kEpsilon, 1.0)) {}
};

/// f_r of a layer, 1/sr, and the share of what lies below that it lets through.
struct OpenPbr::Layer {
  Rgb reflected;
  Rgb transmitted = 1;

  Rgb over(Rgb below) const noexcept { return reflected + transmitted * below; }
};

/// Facets without their Fresnel factor: D G / (4 cos_i cos_o) and albedos towards the viewer.
struct OpenPbr::Highlight {
  double value = 0;
  FacetAlbedo albedo;

  /// What multiple reflections between facets give back, as a factor [Turquin 2019, eq. 14, 16].
  Rgb compensation(Rgb fresnel) const noexcept {
    const double single = albedo.scale + albedo.bias;
    return 1 + (1 - single) / single * fresnel;
  }
};

/// One of each Part.
struct OpenPbr::Parts {
  Film film;
  Highlight facets;
  Rgb diffuse, metal;
  Layer gloss, coating, fuzz;
};

OpenPbr::Roughness OpenPbr::roughness(double roughness, double anisotropy) noexcept {
  const double aspect = 1 - anisotropy, along = square(roughness) * std::sqrt(2 / (1 + square(aspect)));
  const double x = std::clamp(along, kEpsilon, 1.0), y = std::clamp(aspect * along, kEpsilon, 1.0);
  return {x, y, std::sqrt(x * y)};
}

OpenPbr::OpenPbr(const OpenPbrParameters& p) noexcept : p_(p), metal_f0_(p.base_weight * p.base_color) {
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

OpenPbr::Highlight OpenPbr::highlight(const Roughness& alpha, const Geometry& g) const noexcept {
  const double d = square(g.h.x / alpha.x) + square(g.h.y / alpha.y) + square(g.h.z);
  const double density = 1 / (kPi * alpha.x * alpha.y * d * d);
  // [Heitz 2014, eq. 72, 99], isotropic with the mean roughness
  const double alpha2 = square(alpha.mean);
  const auto stretched = [&](double cosine) { return std::sqrt(alpha2 + (1 - alpha2) * square(cosine)); };
  const double visibility = 0.5 / (stretched(g.cos_i) * g.cos_o + stretched(g.cos_o) * g.cos_i);
  return {density * visibility, FacetAlbedo(g.cos_o, alpha.mean)};
}

Rgb OpenPbr::dielectric_under_film(const Parts& parts, const Geometry& g) const noexcept {
  const Film& under = parts.film;
  const Polarized lower = fresnel_polarized(under.cos_inside, base_ior_ / under.ior);
  // Phases turn by pi at the denser side; parallel ones not beyond Brewster's angle.
  const double base2 = square(base_ior_), film2 = square(under.ior), cos2 = square(under.cos_inside);
  const double beyond = base2 - film2 * (1 - cos2);
  const bool turns_p = base2 * base2 * cos2 < film2 * beyond, turns_s = base2 < film2;
  return fresnel_airy(g.cos_d, under, {{lower.p, lower.p, lower.p}, {turns_p, turns_p, turns_p}},
                      {{lower.s, lower.s, lower.s}, {turns_s, turns_s, turns_s}});
}

Rgb OpenPbr::metal_fresnel(double cosine) const noexcept {
  constexpr double kCos82 = 1.0 / 7, kSin = 1 - kCos82;
  constexpr double kFactor = 1 / (kCos82 * kSin * fifth_power(kSin));
  const double grazing = fifth_power(1 - cosine), dip = cosine * (1 - cosine) * grazing * kFactor;
  const auto schlick = [](double f0, double weight) { return mix(f0, 1, weight); };
  const auto channel = [&](double f0, double f82) {
    return schlick(f0, grazing) - schlick(f0, fifth_power(kSin)) * (1 - f82) * dip;
  };
  return {channel(metal_f0_.r, p_.specular_color.r), channel(metal_f0_.g, p_.specular_color.g),
          channel(metal_f0_.b, p_.specular_color.b)};
}

Rgb OpenPbr::metal_under_film(const Parts& parts, const Geometry& g) const noexcept {
  const Film& under = parts.film;
  const Rgb half = 0.5 * metal_fresnel(under.cos_inside);
  const auto turns = [&](double f0) {
    const double root = std::sqrt(std::clamp(f0, 0.01, 0.99));
    return (1 + root) / (1 - root) < under.ior;
  };
  const LowerFace face{{half.r, half.g, half.b},
                       {turns(metal_f0_.r), turns(metal_f0_.g), turns(metal_f0_.b)}};
  return fresnel_airy(g.cos_d, under, face, face);
}

Rgb OpenPbr::diffuse_base(const Geometry& g) const noexcept {
  const double rough = p_.base_diffuse_roughness, single = 1 / (1 + kFujii1 * rough);
  const double s = g.cos_between - g.cos_i * g.cos_o;
  const double lobe = single * (1 + rough * (s > 0 ? s / std::max(g.cos_i, g.cos_o) : s));
  // light reflected more than once
  const double mean_albedo = single * (1 + kFujii2 * rough);
  const auto lost = [](double albedo) { return std::max(kEpsilon, 1 - albedo); };
  const double multiple = rough == 0 ? kEpsilon  // nothing is lost
                                     : lost(fujii_albedo(g.cos_i, rough)) *
                                           lost(fujii_albedo(g.cos_o, rough)) / lost(mean_albedo);
  return each(p_.base_color, [&](double color) {
    const double again = square(color) * mean_albedo / (1 - color * std::max(0.0, 1 - mean_albedo));
    return p_.base_weight / kPi * (color * lobe + again * multiple);
  });
}

OpenPbr::Layer OpenPbr::gloss_layer(const Parts& parts, const Geometry& g) const noexcept {
  const Highlight& peak = parts.facets;
  const double f0 = reflectance_of_ior(base_ior_);
  const double albedo = f0 * peak.albedo.scale + peak.albedo.bias;
  Layer layer{.reflected = 0, .transmitted = 1};
  const auto add = [&](Rgb fresnel, double weight) {
    const Rgb compensation = peak.compensation(fresnel);
    layer.reflected = layer.reflected + weight * peak.value * fresnel * compensation * p_.specular_color;
    layer.transmitted = layer.transmitted + -weight * albedo * compensation;
  };
  if (p_.thin_film_weight < 1) add(fresnel(g.cos_d, base_ior_), 1 - p_.thin_film_weight);
  if (p_.thin_film_weight > 0)
    add(p_.thin_film_thickness > 0 ? dielectric_under_film(parts, g) : Rgb(fresnel(g.cos_d, base_ior_)),
        p_.thin_film_weight);
  return layer;
}

Rgb OpenPbr::metal_base(const Parts& parts, const Geometry& g) const noexcept {
  const Highlight& peak = parts.facets;
  Rgb sum;
  const auto add = [&](Rgb fresnel, double weight) {
    sum = sum + p_.specular_weight * weight * peak.value * fresnel * peak.compensation(fresnel);
  };
  if (p_.thin_film_weight < 1) add(metal_fresnel(g.cos_d), 1 - p_.thin_film_weight);
  if (p_.thin_film_weight > 0)
    add(p_.thin_film_thickness > 0 ? metal_under_film(parts, g) : metal_fresnel(g.cos_d),
        p_.thin_film_weight);
  return sum;
}

OpenPbr::Layer OpenPbr::coat_layer(const Geometry& g) const noexcept {
  if (p_.coat_weight == 0) return {};
  const Highlight peak = highlight(coat_alpha_, g);
  const double reflectance = fresnel(g.cos_d, p_.coat_ior);
  const double compensation = peak.compensation(reflectance).r;
  const double albedo = reflectance_of_ior(p_.coat_ior) * peak.albedo.scale + peak.albedo.bias;
  return {p_.coat_weight * peak.value * reflectance * compensation,
          1 - p_.coat_weight * albedo * compensation};
}

OpenPbr::Layer OpenPbr::fuzz_layer(const Geometry& g) const noexcept {
  if (p_.fuzz_weight == 0) return {};
  const double x = g.cos_o, y = std::clamp(p_.fuzz_roughness, 0.01, 1.0);
  // albedo and matrix as MaterialX fits the tables of [Zeltner 2022]
  const double width = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
  const double middle = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
  const double offset = y * (0.000654023 + (-0.0207818 + 0.119681 * y) * y) / (1.26264 + y * (-1.92021 + y));
  const double albedo = std::exp(-0.5 * square((x - middle) / width)) / (width * std::sqrt(kTwoPi)) + offset;
  const double a = (2.58126 * x + 0.813703 * y) * y / (1 + 0.310327 * x * x + 2.60994 * x * y);
  const double b = std::sqrt(1 - x) * (y - 1) * y * y * y /
                   (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
  // wi in the frame where wo has no y
  const double sine = std::hypot(g.wo.x, g.wo.y);
  const double along = sine > 0 ? (g.wi.x * g.wo.x + g.wi.y * g.wo.y) / sine : g.wi.x;
  const double across = sine > 0 ? (g.wo.x * g.wi.y - g.wo.y * g.wi.x) / sine : g.wi.y;
  const double length2 = square(a * along + b * g.wi.z) + square(a * across) + square(g.wi.z);
  const double value = p_.fuzz_weight * albedo * square(a / length2) / kPi;
  return {value * p_.fuzz_color, 1 - p_.fuzz_weight * albedo};
}

OpenPbr::PartSet OpenPbr::needed() const noexcept {
  PartSet parts;
  parts[film] = p_.thin_film_weight > 0 && p_.thin_film_thickness > 0;
  parts[facets] = parts[coating] = parts[fuzz] = true;
  parts[base_diffuse] = parts[gloss] = p_.base_metalness < 1;
  parts[metal] = p_.base_metalness > 0;
  return parts;
}

/// What the other's parts do not serve.
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

void OpenPbr::compute(const PartSet& which, const Geometry& g, Parts& parts) const noexcept {
  if (which[film]) parts.film = Film(p_.thin_film_ior, p_.thin_film_thickness, g.cos_d);
  if (which[facets]) parts.facets = highlight(base_alpha_, g);
  if (which[base_diffuse]) parts.diffuse = diffuse_base(g);
  if (which[gloss]) parts.gloss = gloss_layer(parts, g);
  if (which[metal]) parts.metal = metal_base(parts, g);
  if (which[coating]) parts.coating = coat_layer(g);
  if (which[fuzz]) parts.fuzz = fuzz_layer(g);
}

void OpenPbr::join(const Parts& parts, std::span<double> f) const noexcept {
  const Rgb dielectric = p_.base_metalness < 1 ? parts.gloss.over(parts.diffuse) : Rgb();
  const Rgb base = mix(dielectric, p_.base_metalness > 0 ? parts.metal : Rgb(), p_.base_metalness);
  const Rgb value = parts.fuzz.over(parts.coating.over(under_coat_ * base));
  f[0] = std::max(value.r, 0.0);
  f[1] = std::max(value.g, 0.0);
  f[2] = std::max(value.b, 0.0);
}

bool OpenPbr::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) {
    f[0] = f[1] = f[2] = 0;
    return true;
  }
  const Geometry g(wi, wo);
  Parts parts;
  compute(needed(), g, parts);
  join(parts, f);
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
  const OpenPbr::Geometry g(wi, wo);
  OpenPbr::Parts parts;
  material_.compute(material_.needed(), g, parts);
  material_.join(parts, f.first(3));
  for (std::size_t i = 0; i < others_.size(); ++i) {
    OpenPbr::Parts own = parts;
    others_[i].compute(fresh_[i], g, own);
    others_[i].join(own, f.subspan(3 * (i + 1), 3));
  }
}

}  // namespace burnish
