// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/albedo.h>

namespace burnish {

namespace {

constexpr std::size_t kMinRings = 64, kMaxRings = 512, kRingsAtOnce = 8;

/// A direction with two others across it, the first towards the normal.
struct RingFrame {
  Vec3 axis, up, side;
};

RingFrame frame_around(Vec3 axis) noexcept {
  const Vec3 up = Vec3{0, 0, 1} - axis.z * axis;
  const bool at_normal = length(up) < 1e-9;
  const Vec3 x = at_normal ? Vec3{1, 0, 0} : normalize(up);
  return {axis, x, cross(axis, x)};
}

/// Integrals over one ring; joined in order, so that the sum does not depend on the threads.
struct Ring {
  std::vector<double> reflected, clamped;
  double known = 0, all = 0;
};

Ring integrate_ring(BrdfRef source, Vec3 wi, const RingFrame& frame, double radius,
                    double solid_angle_per_azimuth, std::size_t azimuth_count) {
  const auto channels = source.channels();
  Ring ring{.reflected = std::vector<double>(channels), .clamped = std::vector<double>(channels)};
  // cos(theta_o) = level + slope cos(azimuth) is above 0 within `half` of the azimuth towards the normal
  const double level = std::cos(radius) * frame.axis.z;
  const double slope = std::sin(radius) * frame.up.z;
  const double half = slope > 0 ? std::acos(std::clamp(-level / slope, -1.0, 1.0)) : level > 0 ? kPi : 0;
  const double weight = solid_angle_per_azimuth * 2 * half / static_cast<double>(azimuth_count);
  std::vector<DirectionPair> pairs;
  for (std::size_t j = 0; j < azimuth_count; ++j) {
    const double azimuth = half * ((2 * static_cast<double>(j) + 1) / static_cast<double>(azimuth_count) - 1);
    const Vec3 wo = std::cos(radius) * frame.axis +
                    std::sin(radius) * (std::cos(azimuth) * frame.up + std::sin(azimuth) * frame.side);
    if (wo.z > 0) pairs.push_back({wi, wo});
  }
  std::vector<double> values(pairs.size() * channels);
  std::vector<std::uint8_t> known(pairs.size());
  source.eval(pairs, values, known);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double share = weight * pairs[i].wo.z;
    ring.all += share;
    if (!known[i]) continue;
    ring.known += share;
    for (std::size_t c = 0; c < channels; ++c) {
      const double f = values[i * channels + c];
      ring.reflected[c] += share * f;
      ring.clamped[c] += share * std::max(f, 0.0);
    }
  }
  return ring;
}

DirectionalAlbedo integrate(BrdfRef source, Vec3 wi, std::size_t ring_count) {
  const auto channels = source.channels();
  const RingFrame frame = frame_around(mirror(wi));
  const double most_radius = kHalfPi + theta_of(wi);  // the farthest point of the horizon

  // rings about the mirror direction, which crowd around it: radius = most u^2, dr = 2 most u du
  std::vector<Ring> rings(ring_count);
  for_each_chunk(ring_count, kRingsAtOnce, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const double u = (static_cast<double>(k) + 0.5) / static_cast<double>(ring_count);
      const double radius = most_radius * u * u;
      const double width = 2 * most_radius * u / static_cast<double>(ring_count);
      rings[k] = integrate_ring(source, wi, frame, radius, std::sin(radius) * width, ring_count / 2);
    }
  });

  DirectionalAlbedo result{std::vector<double>(channels, 0.0), std::vector<double>(channels, 0.0), 0};
  double known = 0, all = 0;
  for (const Ring& ring : rings) {
    known += ring.known;
    all += ring.all;
    for (std::size_t c = 0; c < channels; ++c) {
      result.albedo[c] += ring.reflected[c];
      result.clamped[c] += ring.clamped[c];
    }
  }
  result.unknown_fraction = std::max(0.0, 1 - known / all);
  return result;
}

/// Returns true if no channel differs by more than `tolerance` of it or of the channels' mean: negative values may
/// take one to 0.
bool agree(std::span<const double> a, std::span<const double> b, double tolerance) {
  const double mean = std::accumulate(a.begin(), a.end(), 0.0) / static_cast<double>(a.size());
  for (std::size_t c = 0; c < a.size(); ++c)
    if (!(std::abs(a[c] - b[c]) <= tolerance * std::max(a[c], mean))) return false;
  return true;
}

}  // namespace

DirectionalAlbedo directional_albedo(BrdfRef source, Vec3 wi, double tolerance) {
  source = source.unclamped();
  // twice as many rings until the figures settle
  DirectionalAlbedo result = integrate(source, wi, kMinRings);
  for (std::size_t rings = 2 * kMinRings; rings <= kMaxRings; rings *= 2) {
    DirectionalAlbedo finer = integrate(source, wi, rings);
    const bool settled = agree(finer.albedo, result.albedo, tolerance);
    result = std::move(finer);
    if (settled) break;
  }
  return result;
}

std::vector<AlbedoAt> albedo_curve(BrdfRef source, std::span<const double> theta_i) {
  std::vector<AlbedoAt> curve;
  for (const double phi : {0.0, kHalfPi})
    for (const double theta : theta_i)
      if (phi == 0 || !source.isotropic())
        curve.push_back({theta, phi, directional_albedo(source, spherical_direction(theta, phi))});
  return curve;
}

}  // namespace burnish
