#include <algorithm>
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/statistics.h>

namespace burnish {

DirectionalAlbedo directional_albedo(BrdfRef source, Vec3 wi) {
  constexpr std::size_t radial_count = 256, azimuth_count = 128;
  const auto channels = static_cast<std::size_t>(source.channels());
  // Any frame around the mirror direction will do.
  const Vec3 axis = mirror(wi);
  const Vec3 x_axis = normalize(cross(std::abs(axis.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, axis));
  const Vec3 y_axis = cross(axis, x_axis);

  /// Integrals over one ring; joined in order, so that the sum does not depend on the threads.
  struct Ring {
    std::vector<double> reflected;
    double known = 0, all = 0;
  };
  std::vector<Ring> rings(radial_count);
  for_each_chunk(radial_count, 8, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<double> f(channels);
    for (std::size_t k = begin; k < end; ++k) {
      Ring& ring = rings[k];
      ring.reflected.assign(channels, 0.0);
      const double u = (static_cast<double>(k) + 0.5) / radial_count;
      const double r = kPi * u * u;
      // dr = 2 pi u du
      const double solid_angle = std::sin(r) * (kTwoPi * u / radial_count) * (kTwoPi / azimuth_count);
      for (std::size_t j = 0; j < azimuth_count; ++j) {
        const double phi = kTwoPi * (static_cast<double>(j) + 0.5) / azimuth_count;
        const Vec3 wo = std::cos(r) * axis + std::sin(r) * (std::cos(phi) * x_axis + std::sin(phi) * y_axis);
        if (wo.z <= 0) continue;
        const double weight = solid_angle * wo.z;
        ring.all += weight;
        if (!source.eval(wi, wo, f)) continue;
        ring.known += weight;
        for (std::size_t c = 0; c < channels; ++c) ring.reflected[c] += weight * f[c];
      }
    }
  });

  DirectionalAlbedo result{std::vector<double>(channels, 0.0), 0};
  double known = 0, all = 0;
  for (const Ring& ring : rings) {
    known += ring.known;
    all += ring.all;
    for (std::size_t c = 0; c < channels; ++c) result.albedo[c] += ring.reflected[c];
  }
  result.unknown_fraction = std::max(0.0, 1 - known / all);
  return result;
}

ReciprocityError reciprocity_error(BrdfRef source, std::size_t count, std::uint64_t seed) {
  const auto channels = static_cast<std::size_t>(source.channels());
  std::vector<double> f(channels), swapped(channels);
  ReciprocityError result;
  double sum = 0;
  for (const auto& [wi, wo] : draw_pairs(count, seed, false)) {
    if (!source.eval(wi, wo, f) || !source.eval(wo, wi, swapped)) continue;
    ++result.pairs;
    for (std::size_t c = 0; c < channels; ++c) {
      const double total = std::abs(f[c] + swapped[c]);
      if (total > 0) sum += 2 * std::abs(f[c] - swapped[c]) / total / static_cast<double>(channels);
    }
  }
  if (result.pairs > 0) result.mean = sum / static_cast<double>(result.pairs);
  return result;
}

}  // namespace burnish
