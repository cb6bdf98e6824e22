// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/render/light/environment_light.h>

namespace burnish {
namespace {

constexpr Vec3 kView{0, 0, 1};

Rgb mix(Rgb a, Rgb b, double t) noexcept {
  return Rgb(1 - t) * a + Rgb(t) * b;
}

bool in_disc(const DistantDisc& disc, Vec3 w) noexcept {
  return dot(w, disc.direction) > std::cos(disc.radius);
}

// Solid angle over 2 pi.
double cap_of(const DistantDisc& disc) noexcept {
  return 1 - std::cos(disc.radius);
}

// Evenly over the disc's solid angle.
Vec3 direction_in(const DistantDisc& disc, Point2 u) noexcept {
  const Vec3 d = disc.direction, across = normalize(cross(d, {d.y, d.z, d.x})), up = cross(d, across);
  const double fall = cap_of(disc) * u.x, sine = std::sqrt(fall * (2 - fall)), phi = kTwoPi * u.y;
  return (1 - fall) * d + sine * (std::cos(phi) * across + std::sin(phi) * up);
}

Rgb sky(const Environment& e, Vec3 w) noexcept {
  if (e.picture) return e.picture->radiance(w);
  if (w.y < 0) return e.ground;
  return mix(e.horizon, e.zenith, 1 - (1 - w.y) * (1 - w.y));
}

void check(BrdfRef brdf, const LightOptions& options) {
  const auto require = [](const char* what, int value, bool fits) {
    if (!fits) throw Error(fmt::format("environment light: expected a fitting {}, found {}", what, value));
  };
  const int side = static_cast<int>(std::lround(std::sqrt(options.samples)));
  require("size", options.size, options.size >= 4 && options.size <= 4096);
  require("count of samples", options.samples, options.samples >= 2 && options.samples <= 1 << 24);
  require("square count of stratified samples", options.samples,
          !options.stratified || side * side == options.samples);
  require("number of channels", brdf.channels(), brdf.channels() == 1 || brdf.channels() == 3);
}

// Calls shade(normal, random numbers of the pixel, x, y) for every pixel of the sphere.
template <class Shade>
void for_each_pixel(const LightOptions& options, const Shade& shade) {
  for_each_chunk(static_cast<std::size_t>(options.size), 1, [&](std::size_t row, std::size_t, std::size_t) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < options.size; ++x) {
      Pcg32 random(options.seed, row * static_cast<std::size_t>(options.size) + static_cast<std::size_t>(x));
      if (const auto n = sphere_normal(options.size, x + 0.5, y + 0.5)) shade(*n, random, x, y);
    }
  });
}

using Channels = std::array<double, 3>;

// f_r cos(theta_i) radiance in three channels, all 0 below the horizon.
Channels light_from(BrdfRef brdf, Vec3 wi, Vec3 wo, Rgb radiance) noexcept {
  Channels f{};
  if (wi.z <= 0) return f;
  brdf.eval(wi, wo, std::span(f).first(brdf.channels()));
  if (brdf.channels() == 1) f[1] = f[2] = f[0];
  return {f[0] * wi.z * radiance.r, f[1] * wi.z * radiance.g, f[2] * wi.z * radiance.b};
}

Point2 point(Pcg32& random, const LightOptions& options, int sample) noexcept {
  const double x = random.uniform(), y = random.uniform();
  if (!options.stratified) return {x, y};
  const int side = static_cast<int>(std::lround(std::sqrt(options.samples)));
  return {(sample % side + x) / side, (sample / side + y) / side};
}

// Calls add(wi, direction of the world, density) for options.samples stratified draws of the guide and as
// many of every disc and of the picture. Whatever drew a direction, it stands for the inverse of all their
// densities together: the balance heuristic [Veach 1995].
template <class Add>
void for_each_draw(SamplerRef guide, const Environment& environment, const LightFrame& frame, Vec3 wo,
                   const LightOptions& options, Pcg32& random, const Add& add) {
  const double count = options.samples;
  const auto weigh = [&](Vec3 wi, Vec3 w) {
    double density = count * guide.pdf(wi, wo);
    for (const DistantDisc& disc : environment.discs)
      if (in_disc(disc, w)) density += count / (kTwoPi * cap_of(disc));
    if (environment.picture) density += count * environment.picture->pdf(w);
    if (density > 0) add(wi, w, density);
  };

  // draws of the guide, of every disc, of the picture
  for (int i = 0; i < options.samples; ++i) {
    const DrawnDirection drawn = guide.sample_wi(wo, point(random, options, i));
    if (drawn.pdf > 0) weigh(drawn.wi, frame.world(drawn.wi));
  }
  const auto weigh_world = [&](Vec3 w) { weigh(frame.local(w), w); };
  for (const DistantDisc& disc : environment.discs)
    for (int i = 0; i < options.samples; ++i) weigh_world(direction_in(disc, point(random, options, i)));
  for (int i = 0; environment.picture && i < options.samples; ++i)
    if (const DrawnDirection drawn = environment.picture->draw(point(random, options, i)); drawn.pdf > 0)
      weigh_world(drawn.wi);
}

}  // namespace

LightFrame sphere_frame(Vec3 n) noexcept {
  const Vec3 x = sphere_local(n, {1, 0, 0}), y = sphere_local(n, {0, 1, 0}), z = sphere_local(n, {0, 0, 1});
  return {{x.z, y.z, z.z}, {x.x, y.x, z.x}, {x.y, y.y, z.y}};
}

Rgb radiance_in_environment(BrdfRef brdf, SamplerRef guide, const Environment& environment,
                            const LightFrame& frame, Vec3 v, int side, Pcg32& random) {
  const Vec3 wo = frame.local(v);
  Rgb sum;
  if (wo.z <= 0) return sum;
  for_each_draw(guide, environment, frame, wo, {.samples = side * side, .stratified = true}, random,
                [&](Vec3 wi, Vec3 w, double density) {
                  const Channels light = light_from(brdf, wi, wo, environment.radiance(w));
                  sum = sum + Rgb(1 / density) * Rgb(light[0], light[1], light[2]);
                });
  return sum;
}

Rgb Environment::radiance(Vec3 w) const noexcept {
  Rgb sum = sky(*this, w);
  for (const DistantDisc& disc : discs)
    if (in_disc(disc, w)) sum = sum + disc.radiance;
  return sum;
}

std::span<const Environment> environments() {
  static const Environment all[] = {{"sun",
                                     {0.25, 0.45, 0.9},
                                     {0.9, 0.95, 1},
                                     {0.15, 0.13, 0.1},
                                     {{normalize({0.5, 0.7, 0.6}), radians(1), 6000}}},
                                    {"studio",
                                     {0.05, 0.05, 0.05},
                                     {0.1, 0.1, 0.1},
                                     {0.03, 0.03, 0.03},
                                     {{normalize({-0.6, 0.6, 0.7}), radians(12), 15},
                                      {normalize({0.9, 0.1, 0.3}), radians(20), 2},
                                      {normalize({0.3, 0.6, -0.7}), radians(6), 30}}}};
  return all;
}

std::optional<Environment> find_environment(std::string_view name) {
  const auto found = std::ranges::find(environments(), name, &Environment::name);
  if (found == environments().end()) return {};
  return *found;
}

Environment open_environment(const std::string& name_or_file) {
  if (auto known = find_environment(name_or_file)) return *std::move(known);
  return {.name = name_or_file,
          .picture = std::make_shared<const SkyImage>(parse_sky(read_file(name_or_file)))};
}

std::vector<DiscPoint> disc_points(const Environment& environment) {
  constexpr int kPoints = 64;
  std::vector<DiscPoint> points;
  for (const DistantDisc& disc : environment.discs)
    for (int i = 0; i < kPoints; ++i) {
      // Fibonacci's spiral, even over the solid angle
      const double turns = i * 0.5 * (3 - std::sqrt(5.0));
      points.push_back({direction_in(disc, {(i + 0.5) / kPoints, turns - std::floor(turns)}),
                        disc.radiance * kTwoPi * cap_of(disc) / kPoints});
    }
  return points;
}

Environment turned(Environment environment, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (DistantDisc& disc : environment.discs) {
    const Vec3 d = disc.direction;
    disc.direction = {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
  }
  return environment;
}

LightRender render_in_environment(BrdfRef brdf, SamplerRef sampler, const Environment& environment,
                                  const LightOptions& options) {
  check(brdf, options);
  LightRender render{Image(options.size, options.size, 3), Image(options.size, options.size, 3)};
  for_each_pixel(options, [&](Vec3 n, Pcg32& random, int x, int y) {
    const LightFrame frame = sphere_frame(n);
    const Vec3 wo = frame.local(kView);
    Channels sum{}, squares{};
    for (int i = 0; i < options.samples; ++i) {
      const DrawnDirection drawn = sampler.sample_wi(wo, point(random, options, i));
      if (drawn.pdf <= 0) continue;
      const Channels light = light_from(brdf, drawn.wi, wo, environment.radiance(frame.world(drawn.wi)));
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = light[c] / drawn.pdf;
        sum[c] += value;
        squares[c] += value * value;
      }
    }
    // the mean, and the variance of one sample by sums of squares
    for (std::size_t c = 0; c < 3; ++c) {
      const double mean = sum[c] / options.samples;
      render.mean.at(x, y)[c] = static_cast<float>(mean);
      render.variance.at(x, y)[c] = static_cast<float>((squares[c] - sum[c] * mean) / (options.samples - 1));
    }
  });
  return render;
}

LightMoments moments_in_environment(BrdfRef brdf, SamplerRef guide, std::span<const SamplerRef> samplers,
                                    const Environment& environment, const LightOptions& options) {
  LightOptions stratified = options;
  stratified.stratified = true;
  check(brdf, stratified);
  const Image black(options.size, options.size, 3);
  LightMoments moments{black, std::vector(samplers.size(), black)};
  for_each_pixel(options, [&](Vec3 n, Pcg32& random, int x, int y) {
    const LightFrame frame = sphere_frame(n);
    const Vec3 wo = frame.local(kView);
    Channels mean{};
    std::vector<Channels> squares(samplers.size());
    // E[(light / pdf)^2] of a sampler is the integral of light^2 / pdf
    for_each_draw(guide, environment, frame, wo, stratified, random, [&](Vec3 wi, Vec3 w, double density) {
      const Channels light = light_from(brdf, wi, wo, environment.radiance(w));
      for (std::size_t c = 0; c < 3; ++c) mean[c] += light[c] / density;
      for (std::size_t s = 0; s < samplers.size(); ++s)
        if (const double pdf = samplers[s].pdf(wi, wo); pdf > 0)
          for (std::size_t c = 0; c < 3; ++c) squares[s][c] += light[c] * light[c] / (pdf * density);
    });
    for (std::size_t c = 0; c < 3; ++c) {
      moments.mean.at(x, y)[c] = static_cast<float>(mean[c]);
      for (std::size_t s = 0; s < samplers.size(); ++s)
        moments.variance[s].at(x, y)[c] =
            static_cast<float>(std::max(0.0, squares[s][c] - mean[c] * mean[c]));
    }
  });
  return moments;
}

}  // namespace burnish
