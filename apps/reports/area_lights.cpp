// SPDX-License-Identifier: Apache-2.0
// Draws spheres lit by square lamps with tables of area lights, and with those of a fitted GGX. Compares them with
// samples of the lamp.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/analytic_fit.h>
#include <burnish/io/open_source.h>
#include <burnish/lighting/area_light_fit.h>
#include <burnish/lighting/area_lights.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/parameterization/visible_half.h>
#include <burnish/reflectance/sample_source.h>

#include "report.h"

namespace burnish::reports {

namespace {

constexpr std::array kLampDegrees{10, 30, 90};
constexpr double kLampDistance = 4, kLampAngle_deg = 40;

// A square lamp, seen from the sphere's middle.
struct Lamp {
  Vec3 centre, u, v;  // half the sides

  explicit Lamp(double degrees) {
    const double half = kLampDistance * std::tan(0.5 * radians(degrees)), a = radians(kLampAngle_deg);
    const Vec3 to{std::sin(a), 0, std::cos(a)};
    centre = kLampDistance * to;
    u = half * normalize(cross({0, 1, 0}, to));
    v = half * cross(to, normalize(u));
  }
};

// Calls shade(normal, pixel's number) for every pixel of the sphere.
template <class Shade>
Image drawn_sphere(int size, const Shade& shade) {
  Image image(size, size, 3);
  for_each_chunk(static_cast<std::size_t>(size), 1, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < size; ++x) {
        const auto n = sphere_normal(size, x + 0.5, y + 0.5);
        if (!n) continue;
        const Rgb value = shade(*n, static_cast<std::uint64_t>(y * size + x));
        const auto pixel = image.at(x, y);
        pixel[0] = static_cast<float>(value.r);
        pixel[1] = static_cast<float>(value.g);
        pixel[2] = static_cast<float>(value.b);
      }
  });
  return image;
}

Image drawn_by_table(const AreaLightTable& table, const Lamp& lamp, int size) {
  const auto corners = rectangle_light(lamp.centre, lamp.u, lamp.v);
  return drawn_sphere(size, [&](Vec3 n, std::uint64_t) {
    std::array<Vec3, 4> local;
    for (std::size_t k = 0; k < 4; ++k) local[k] = sphere_local(n, corners[k] - n);
    return reflected(table, local, sphere_local(n, {0, 0, 1}));
  });
}

// Computes one pixel of the truth from side^2 places on the lamp and side^2 half vectors. The logarithm of the half
// vectors' tan^2(theta_h / 2) is evenly spread. Both sets are stratified, and weighted by the sum of their densities
// [Veach1995].
class LampSamples {
 public:
  LampSamples(BrdfRef brdf, const Lamp& lamp, Vec3 n, int side)
      : brdf_(brdf),
        side_(side),
        wo_(sphere_local(n, {0, 0, 1})),
        centre_(sphere_local(n, lamp.centre - n)),
        u_(sphere_local(n, lamp.u)),
        v_(sphere_local(n, lamp.v)),
        normal_(normalize(cross(u_, v_))) {}

  Rgb drawn(Pcg32& random) {
    const auto place = [&](int i) { return (i + random.uniform()) / side_; };
    for (int i = 0; i < side_; ++i)
      for (int k = 0; k < side_; ++k) {
        const double a = 2 * place(i) - 1;
        add(normalize(centre_ + a * u_ + (2 * place(k) - 1) * v_));
      }
    for (int i = 0; i < side_; ++i)
      for (int k = 0; k < side_; ++k) {
        const double phi = kTwoPi * place(i), x = std::cos(phi), y = std::sin(phi);
        const double m =
            largest_visible_half(wo_.x * x + wo_.y * y, wo_.z) * std::exp(kRange * (place(k) - 1));
        const double sine = 2 * std::sqrt(m) / (1 + m), cosine = (1 - m) / (1 + m);
        const Vec3 h{sine * x, sine * y, cosine};
        add(2 * dot(wo_, h) * h - wo_);
      }
    return sum_;
  }

 private:
  static constexpr double kRange = 18.42;  // length of the logarithm's interval: 1e8

  void add(Vec3 wi) {
    const double across = dot(wi, normal_), height = dot(centre_, normal_);
    if (wi.z <= 0 || across * height <= 0) return;
    const Vec3 at = (height / across) * wi, from = at - centre_;
    if (std::abs(dot(from, u_)) > dot(u_, u_) || std::abs(dot(from, v_)) > dot(v_, v_)) return;
    const double count = static_cast<double>(side_) * side_;
    const double of_lamp = count * dot(at, at) / (4 * length(u_) * length(v_) * std::abs(across));
    std::array<double, 3> f{};
    brdf_.eval(wi, wo_, std::span(f).first(brdf_.channels()));
    if (brdf_.channels() == 1) f[1] = f[2] = f[0];
    sum_ = sum_ + Rgb(wi.z / (of_lamp + count * half_density(wi))) * Rgb(f[0], f[1], f[2]);
  }
  double half_density(Vec3 wi) const {
    const Vec3 h = half_vector(wi, wo_);
    const double m = (1 - h.z) / (1 + h.z), size = std::hypot(h.x, h.y);
    if (size < 1e-12) return 0;
    const double largest = largest_visible_half((wo_.x * h.x + wo_.y * h.y) / size, wo_.z);
    if (m > largest || m < largest * std::exp(-kRange)) return 0;
    // The solid angle of wi is 8 wo.h m / (1 + m)^2 d(log m) dphi.
    return (1 + m) * (1 + m) / (8 * dot(wo_, h) * m * kRange * kTwoPi);
  }

  BrdfRef brdf_;
  int side_;
  Vec3 wo_, centre_, u_, v_, normal_;
  Rgb sum_;
};

Image drawn_by_samples(BrdfRef brdf, const Lamp& lamp, int size, int side) {
  return drawn_sphere(size, [&](Vec3 n, std::uint64_t pixel) {
    Pcg32 random(1, pixel);
    return LampSamples(brdf, lamp, n, side).drawn(random);
  });
}

// Returns the psnr in dB of each table's picture.
std::vector<double> scores(BrdfRef brdf, std::span<const AreaLightTable> tables, double degrees, int size,
                           int side) {
  const Lamp lamp(degrees);
  const std::array<LitSphere, 1> truth{{{drawn_by_samples(brdf, lamp, size, side), {}}}};
  const double exposure = sphere_exposure(truth);
  const Image shown = tone_map(truth[0].image, exposure);
  std::vector<double> all;
  for (const AreaLightTable& table : tables)
    all.push_back(psnr(mean_squared_error(shown, tone_map(drawn_by_table(table, lamp, size), exposure))));
  return all;
}

// Follows the customary way: a GGX with a Lambertian part is fitted, and its highlight becomes one lobe of a table.
AreaLightTable table_of_ggx(const Source& source) {
  const AnalyticFit fit = fit_analytic(from_brdf(source.ref(), 8000, 1, false), "ggx");
  return fit_area_lights(fit.brdf, {.lobes = 1});
}

}  // namespace

void report_area_lights(const ReportOptions& options) {
  if (!options.data) throw Error("BURNISH_DATA: expected the folder of measurements, found nothing");
  std::vector<std::string> specs;
  for (const fs::path& file : files_in(*options.data / "rgl")) specs.push_back(file.string());
  if (specs.empty()) throw Error::in_file(*options.data / "rgl", "measurements", "none");
  if (options.quick) specs.resize(1);
  specs.emplace_back("ggx:alpha_x=0.12,alpha_y=0.35,f0=0.9");
  specs.emplace_back("satin:f0=0.85/0.35/0.16,kd=0.06/0.01/0.03");
  const int size = options.quick ? 24 : 64, side = options.quick ? 16 : 32;

  Page page(options, "area-lights");
  Table table({"material", "lobes", "bytes a lobe", "bytes", "10°", "30°", "90°", "GGX, 10°", "GGX, 30°",
               "GGX, 90°"});
  std::vector<double> ours(kLampDegrees.size()), rivals(kLampDegrees.size());
  std::size_t largest_lobe = 0, reached = 0;
  for (const std::string& spec : specs) {
    const std::string name =
        spec.find(':') == spec.npos ? fs::path(spec).stem().string() : spec.substr(0, spec.find(':'));
    tell("area lights: " + name);
    const Source source = open_source(spec, {});
    const std::vector<AreaLightTable> tables{fit_area_lights(source.ref()), table_of_ggx(source)};
    std::vector<std::string> line{name, fmt::format("{}", tables[0].lobes.size()),
                                  fmt::format("{}", tables[0].lobe_bytes()),
                                  fmt::format("{}", tables[0].bytes())};
    std::vector<std::string> beside;
    for (std::size_t k = 0; k < kLampDegrees.size(); ++k) {
      const std::vector<double> db = scores(source.ref(), tables, kLampDegrees[k], size, side);
      ours[k] += db[0] / static_cast<double>(specs.size());
      rivals[k] += db[1] / static_cast<double>(specs.size());
      reached += db[0] >= 38;
      line.push_back(fmt::format("{:.1f}", db[0]));
      beside.push_back(fmt::format("{:.1f}", db[1]));
    }
    largest_lobe = std::max(largest_lobe, tables[0].lobe_bytes());
    table.add(joined(line, beside));
  }
  table.add(joined(joined({"mean", "", "", ""}, cells("{:.1f}", ours)), cells("{:.1f}", rivals)));
  page["table"] = table.markdown();
  page["size"] = fmt::format("{}", size);
  page["samples"] = fmt::format("{}", 2 * side * side);
  page["lobe"] = fmt::format("{}", largest_lobe);
  page["reached"] = fmt::format("{}", reached);
  page["pictures"] = fmt::format("{}", specs.size() * kLampDegrees.size());
  page.write_rows("psnr", table);
  page.write();
}

}  // namespace burnish::reports
