// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/render/light/image_based_light.h>
#include <burnish/render/light/lobe_parts.h>
#include <burnish/render/light/parabolic_pair.h>
#include <burnish/render/light/prefiltered_formula.h>

namespace burnish {
namespace {

constexpr int kRings = 96;   // angles gamma about an axis, gamma = pi (ring / kRings)^2
constexpr int kSpokes = 32;  // azimuths of a ring of the sky

double ring_angle(double ring) noexcept {
  return kPi * (ring / kRings) * (ring / kRings);
}

using Axes = TurnedAxes<Vec3>;

// sin(theta) and cos(theta) of a slice's view, kept off the horizon, where a BRDF is 0.
Vec3 slice_view(int slice, int slices) noexcept {
  const double theta = std::min(2 * std::atan(static_cast<double>(slice) / (slices - 1)), radians(89.5));
  return {-std::sin(theta), 0, std::cos(theta)};
}

// (the inside factors) cos(theta_i) about an axis, in azimuthal harmonics on rings. Directions are in the local
// frame of a slice: the viewer towards -x, so that the mirror direction lies towards +x.
struct Kernel {
  using Harmonics = std::array<Channels, kMaxMaps / 2 + 1>;

  double axis = 0;                   // radians from the normal towards +x
  std::vector<Harmonics> even, odd;  // a ring: of cos(m psi), of sin(m psi)
};

Kernel kernel_of(const FactoredBrdf& inside, Vec3 wo, int orders) {
  // the kernel, and the direction at angle gamma and azimuth psi about an axis in the plane of view
  const auto value = [&](Vec3 wi) {
    Channels f{};
    if (wi.z <= 0) return f;
    f = eval_channels(inside, wi, wo);
    for (double& c : f) c *= wi.z;
    return f;
  };
  const auto about = [](double axis, double gamma, double psi) {
    const double x = std::sin(gamma) * std::cos(psi), y = std::sin(gamma) * std::sin(psi),
                 z = std::cos(gamma);
    return Vec3{std::cos(axis) * x + std::sin(axis) * z, y, std::cos(axis) * z - std::sin(axis) * x};
  };

  // The mean of the kernel squared, by rings about the mirror direction, which crowd where lobes are.
  const double mirror_angle = std::atan2(-wo.x, wo.z);
  Vec3 mean{};
  for (int ring = 0; ring < kRings; ++ring)
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double gamma = ring_angle(ring + 0.5), psi = kTwoPi * (spoke + 0.5) / kSpokes;
      const Vec3 wi = about(mirror_angle, gamma, psi);
      const Channels f = value(wi);
      const double area = std::sin(gamma) * (ring + 0.5);  // d gamma is proportional to the ring
      mean = mean + area * (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) * wi;
    }

  // its harmonics on rings about that axis, Fourier coefficients in psi
  Kernel kernel{.axis = std::atan2(mean.x, mean.z), .even = {}, .odd = {}};
  kernel.even.resize(kRings + 1);
  kernel.odd.resize(kRings + 1);
  constexpr int kAzimuths = 2 * kSpokes;
  for (int ring = 0; ring <= kRings; ++ring)
    for (int spoke = 0; spoke < kAzimuths; ++spoke) {
      const double psi = kTwoPi * (spoke + 0.5) / kAzimuths;
      const Channels f = value(about(kernel.axis, ring_angle(ring), psi));
      for (int m = 0; m <= orders; ++m)
        for (std::size_t c = 0; c < 3; ++c) {
          const double share = f[c] * (m == 0 ? 1 : 2) / kAzimuths;
          kernel.even[static_cast<std::size_t>(ring)][static_cast<std::size_t>(m)][c] +=
              share * std::cos(m * psi);
          kernel.odd[static_cast<std::size_t>(ring)][static_cast<std::size_t>(m)][c] +=
              share * std::sin(m * psi);
        }
    }
  return kernel;
}

std::array<double, kMaxMaps> harmonics_of(double c, double s) noexcept {
  return harmonics<kMaxMaps>(c, s);
}

// Light at one ring, weighted by each harmonic of its azimuth.
using RingLight = std::array<Channels, kMaxMaps>;

void add(RingLight& to, const std::array<double, kMaxMaps>& harmonics, double weight, Rgb light) noexcept {
  for (std::size_t h = 0; h < kMaxMaps; ++h) {
    const double w = weight * harmonics[h];
    to[h][0] += w * light.r;
    to[h][1] += w * light.g;
    to[h][2] += w * light.b;
  }
}

// Solid angle of a ring over 2 pi: integral of the ring's hat function times sin(gamma).
std::vector<double> ring_areas() {
  std::vector<double> areas(kRings + 1);
  constexpr int kSteps = 16;
  for (int ring = 0; ring < kRings; ++ring)
    for (int i = 0; i < kSteps; ++i) {
      const double low = ring_angle(ring), high = ring_angle(ring + 1), t = (i + 0.5) / kSteps;
      const double part = std::sin(low + t * (high - low)) * (high - low) / kSteps;
      areas[static_cast<std::size_t>(ring)] += (1 - t) * part;
      areas[static_cast<std::size_t>(ring) + 1] += t * part;
    }
  return areas;
}

// A picture is summed over its texels, of 2.8 degrees: narrower than what the maps show.
void append_texels(std::vector<DiscPoint>& points, const SkyImage& picture) {
  const SkyImage sky(smaller_sky(picture.image(), 128));
  for (int y = 0; y < sky.image().height; ++y)
    for (int x = 0; x < sky.image().width; ++x) {
      const auto texel = sky.image().at(x, y);
      points.push_back({sky.direction(x, y), Rgb(sky.solid_angle(y)) * Rgb(texel[0], texel[1], texel[2])});
    }
}

// An environment as it is summed over rings: a sky that is sampled at every spoke (none where a picture says
// all), and points of light.
struct RingSources {
  Environment sky;
  bool samples_sky = true;
  std::vector<double> areas;  // of the rings
  std::vector<DiscPoint> points;
};

RingSources sources_of(const Environment& environment) {
  RingSources sources{.sky = environment,
                      .samples_sky = !environment.picture,
                      .areas = ring_areas(),
                      .points = disc_points(environment)};
  if (environment.picture) append_texels(sources.points, *environment.picture);
  sources.sky.discs.clear();
  return sources;
}

// The sky about an axis of one half, at the spokes of every ring.
void add_sky(std::vector<RingLight>& light, Vec3 axis, const Axes& across, int half,
             const RingSources& sources) {
  for (int ring = 0; ring <= kRings; ++ring) {
    const double sine = std::sin(ring_angle(ring)), cosine = std::cos(ring_angle(ring));
    const double turn = 0.618 * ring;  // spokes of neighbouring rings do not line up
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double psi = kTwoPi * (spoke + turn) / kSpokes, c = std::cos(psi), s = std::sin(psi);
      const Vec3 w = cosine * axis + (sine * c) * across.x + (sine * s) * across.z;
      add(light[static_cast<std::size_t>(ring)], harmonics_of(c, s),
          sources.areas[static_cast<std::size_t>(ring)] * kTwoPi / kSpokes,
          sources.sky.radiance(in_half(half, w)));
    }
  }
}

// A point's light, shared by the two rings next to it: linear in gamma, as kernels are between rings.
void add_point(std::vector<RingLight>& light, Vec3 axis, const Axes& across, int half,
               const DiscPoint& point) {
  const Vec3 w = in_half(half, point.direction);
  const double along = dot(w, axis), x = dot(w, across.x), z = dot(w, across.z), sine = std::hypot(x, z);
  const double at = kRings * std::sqrt(std::atan2(sine, along) / kPi);
  const auto ring = std::min(static_cast<std::size_t>(at), std::size_t{kRings - 1});
  const auto harmonics = sine > 0 ? harmonics_of(x / sine, z / sine) : std::array<double, kMaxMaps>{1};
  const double low = ring_angle(static_cast<double>(ring)), high = ring_angle(static_cast<double>(ring) + 1);
  const double part = (std::atan2(sine, along) - low) / (high - low);
  add(light[ring], harmonics, 1 - part, point.light);
  add(light[ring + 1], harmonics, part, point.light);
}

// All light about an axis of one half, by rings.
std::vector<RingLight> light_about(Vec3 axis, const Axes& across, int half, const RingSources& sources) {
  std::vector<RingLight> light(kRings + 1);
  if (sources.samples_sky) add_sky(light, axis, across, half, sources);
  for (const DiscPoint& point : sources.points) add_point(light, axis, across, half, point);
  return light;
}

// Kernels count their azimuth about the axis in the world, which a mirror turns: 1 or -1.
double azimuth_sense(Vec3 axis, const Axes& across, int half) noexcept {
  return (dot(cross(axis, across.x), across.z) > 0) != (half == 1) ? 1 : -1;
}

// Returns the light about a kernel's axis after filtering, in one map. Kernels count their azimuth from the tilt, at
// alpha: cos(m (psi - alpha)) = cos(m psi) cos(m alpha) + sin(m psi) sin(m alpha), and the sine likewise. Map 2 m - 1
// goes with cos(m alpha), map 2 m with sin(m alpha).
Channels filtered(const Kernel& kernel, const std::vector<RingLight>& light, std::size_t map,
                  double sense) noexcept {
  const std::size_t order = (map + 1) / 2, other = map == 0 ? 0 : map % 2 ? map + 1 : map - 1;
  const double turned = map % 2 ? sense : -sense;
  Channels value{};
  for (std::size_t ring = 0; ring <= kRings; ++ring)
    for (std::size_t c = 0; c < 3; ++c)
      value[c] += kernel.even[ring][order][c] * light[ring][map][c] +
                  turned * kernel.odd[ring][order][c] * light[ring][other][c];
  return value;
}

// A lobe's kernels, one a slice.
std::vector<Kernel> kernels_of(const FactoredBrdf& inside, const PrefilterOptions& options) {
  std::vector<Kernel> kernels(static_cast<std::size_t>(options.slices));
  for_each_chunk(kernels.size(), 1, [&](std::size_t s, std::size_t, std::size_t) {
    kernels[s] = kernel_of(inside, slice_view(static_cast<int>(s), options.slices), options.harmonics);
  });
  return kernels;
}

void check(const FactoredBrdf& brdf, const PrefilterOptions& options) {
  const auto require = [](const char* what, int value, int least, int most) {
    if (value < least || value > most)
      throw Error(
          fmt::format("image-based light: expected {} in [{}, {}], found {}", what, least, most, value));
  };
  require("slices", options.slices, 2, 64);
  require("a side", options.side, 8, 512);
  require("harmonics", options.harmonics, 0, 4);
  if (!brdf.isotropic())
    throw Error("image-based light: expected an isotropic model, found an anisotropic one");
  if (brdf.channels() != 1 && brdf.channels() != 3)
    throw Error(fmt::format("image-based light: expected 1 or 3 channels, found {}", brdf.channels()));
}

// Half floats hold maps whose largest values are 1; the rest goes into the scale.
void normalize_maps(PrefilteredLobe& prefiltered) {
  const FactoredBrdf& outside = prefiltered.outside;
  Lobe lobe = outside.lobes()[0];
  std::array<float, 3> largest{};
  for (std::size_t i = 0; i < prefiltered.maps.size(); ++i)
    largest[i % 3] = std::max(largest[i % 3], std::abs(prefiltered.maps[i]));
  if (lobe.scale.size() == 1) largest.fill(std::ranges::max(largest));
  for (std::size_t i = 0; i < prefiltered.maps.size(); ++i)
    if (largest[i % 3] > 0) prefiltered.maps[i] /= largest[i % 3];
  for (std::size_t c = 0; c < lobe.scale.size(); ++c) lobe.scale[c] *= static_cast<double>(largest[c]);
  prefiltered.outside =
      FactoredBrdf(outside.channels(), {outside.tables().begin(), outside.tables().end()}, {lobe});
}

}  // namespace

std::vector<float> ImageBasedLight::joined_maps() const {
  std::vector<float> all;
  for (const PrefilteredLobe& lobe : lobes) all.insert(all.end(), lobe.maps.begin(), lobe.maps.end());
  return all;
}

std::size_t ImageBasedLight::bytes() const noexcept {
  std::size_t values = 0;
  for (const PrefilteredLobe& lobe : lobes) values += lobe.maps.size();
  return values / 3 * 8;
}

int ImageBasedLight::fetches() const noexcept {
  int count = 0;
  for (const PrefilteredLobe& lobe : lobes)
    count += map_count() + static_cast<int>(lobe.outside.lobes()[0].factors.size());
  return count;
}

Rgb ImageBasedLight::radiance(Vec3 n, Vec3 v) const noexcept {
  const double cos_o = std::min(dot(n, v), 1.0);
  if (cos_o <= 0) return {};
  const Vec3 away = cos_o * n - v;  // from the viewer, in the plane of view and normal
  const double sin_o = length(away), t = sin_o / (1 + cos_o);
  const Vec3 wo{-sin_o, 0, cos_o};
  // kernels are round where normal and view coincide: any azimuth will do there
  const Vec3 plane = (1 / std::max(sin_o, kMinSine)) * away;

  // the two slices next to the view
  const int side = options.side;
  const double slice_at = t * (options.slices - 1);
  const int slice = std::min(static_cast<int>(slice_at), options.slices - 2);
  const double slice_part = slice_at - slice;
  Rgb sum;
  for (const PrefilteredLobe& lobe : lobes) {
    // the kernel's axis in the world, and the tilt that its azimuth counts from
    const auto s = static_cast<std::size_t>(slice);
    const double angle = (1 - slice_part) * lobe.axis[s] + slice_part * lobe.axis[s + 1];
    const auto [axis_world, tilt_world] = kernel_axis(n, plane, angle);

    // its place in the map of its half, and the azimuth of the tilt there
    const int half = axis_world.y < 0;
    const Vec3 axis = in_half(half, axis_world), tilt = in_half(half, tilt_world);
    const Axes across(axis);
    const auto harmonics = harmonics_of(dot(tilt, across.x), dot(tilt, across.z));
    const auto [x, y] = map_place(axis, side);
    const int x0 = std::clamp(static_cast<int>(x), 0, side - 2),
              y0 = std::clamp(static_cast<int>(y), 0, side - 2);

    // every map, linear in place and slice
    Channels light{};
    for (int map = 0; map < map_count(); ++map)
      for (int corner = 0; corner < 8; ++corner) {
        const int dx = corner & 1, dy = corner >> 1 & 1, ds = corner >> 2;
        const double weight = (dx ? x - x0 : 1 - x + x0) * (dy ? y - y0 : 1 - y + y0) *
                              (ds ? slice_part : 1 - slice_part) * harmonics[static_cast<std::size_t>(map)];
        const int row = (map * options.slices + slice + ds) * side + y0 + dy;
        const auto at = static_cast<std::size_t>(3 * (row * 2 * side + half * side + x0 + dx));
        for (std::size_t c = 0; c < 3; ++c) light[c] += weight * lobe.maps[at + c];
      }
    const Channels outside = eval_channels(lobe.outside, wo, wo);
    sum = sum + Rgb{outside[0] * light[0], outside[1] * light[1], outside[2] * light[2]};
  }
  return {std::max(sum.r, 0.0), std::max(sum.g, 0.0), std::max(sum.b, 0.0)};
}

ImageBasedLight prefilter(const FactoredBrdf& brdf, const Environment& environment,
                          const PrefilterOptions& options) {
  check(brdf, options);
  ImageBasedLight result{options, {}};
  const auto slices = static_cast<std::size_t>(options.slices), side = static_cast<std::size_t>(options.side);
  const auto maps = static_cast<std::size_t>(result.map_count());

  // every lobe's kernels, one a slice
  std::vector<std::vector<Kernel>> kernels;
  for (const Lobe& lobe : brdf.lobes()) {
    auto [outside, inside] = parts_of(brdf, lobe);
    result.lobes.push_back({std::move(outside), {}, std::vector<float>(maps * slices * side * side * 6)});
    kernels.push_back(kernels_of(inside, options));
    for (const Kernel& kernel : kernels.back()) result.lobes.back().axis.push_back(kernel.axis);
  }

  // every texel's light about its axis, then what each kernel makes of it
  const RingSources sources = sources_of(environment);
  for_each_chunk(side, 1, [&](std::size_t row, std::size_t, std::size_t) {
    for (std::size_t column = 0; column < 2 * side; ++column) {
      const int half = column >= side;
      const Vec3 axis = map_direction(static_cast<int>(column % side), static_cast<int>(row), options.side);
      const Axes across(axis);
      const std::vector<RingLight> light = light_about(axis, across, half, sources);
      const double sense = azimuth_sense(axis, across, half);
      for (std::size_t j = 0; j < kernels.size(); ++j)
        for (std::size_t slice = 0; slice < slices; ++slice)
          for (std::size_t map = 0; map < maps; ++map) {
            const Channels value = filtered(kernels[j][slice], light, map, sense);
            float* texel =
                result.lobes[j].maps.data() + 3 * (((map * slices + slice) * side + row) * 2 * side + column);
            for (std::size_t c = 0; c < 3; ++c) texel[c] = static_cast<float>(value[c]);
          }
    }
  });
  for (PrefilteredLobe& lobe : result.lobes) normalize_maps(lobe);
  return result;
}

}  // namespace burnish
