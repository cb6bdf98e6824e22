// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <vector>

#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/patch_means.h>

namespace burnish {

namespace {

constexpr std::size_t kAlong = 3, kPlaces = kAlong * kAlong;

/// Returns directions that each stand for an equal projected solid angle of a patch.
std::array<Vec3, kPlaces> places_in(const PatchBasis& basis, std::size_t patch) {
  std::size_t r = 0;
  while (basis.rings[r].first + basis.rings[r].count <= patch) ++r;
  const PatchRing& ring = basis.rings[r];
  // Equal steps of sin^2(theta) are equal steps of the projected solid angle.
  const double low = std::pow(std::sin(ring.theta_low), 2), high = std::pow(std::sin(ring.theta_high), 2);
  std::array<Vec3, kPlaces> places;
  for (std::size_t t = 0; t < kAlong; ++t)
    for (std::size_t p = 0; p < kAlong; ++p) {
      const double sine = std::sqrt(low + (high - low) * (static_cast<double>(t) + 0.5) / kAlong);
      const double turn =
          (static_cast<double>(patch - ring.first) - 0.5 + (static_cast<double>(p) + 0.5) / kAlong) /
          static_cast<double>(ring.count);
      places[t * kAlong + p] = spherical_direction(std::asin(sine), basis.first_azimuth + kTwoPi * turn);
    }
  return places;
}

}  // namespace

PatchTable patch_means(BrdfRef source, PatchBasis incident, PatchBasis outgoing) {
  const std::size_t channels = source.channels(), columns = incident.size();
  PatchTable table{.incident = std::move(incident),
                   .outgoing = std::move(outgoing),
                   .values = {},
                   .channel_count = channels};
  table.values.resize(columns * table.outgoing.size() * channels);
  std::vector<std::array<Vec3, kPlaces>> from(columns);
  for (std::size_t i = 0; i < columns; ++i) from[i] = places_in(table.incident, i);
  for_each_chunk(table.outgoing.size(), 1, [&](std::size_t, std::size_t begin, std::size_t end) {
    constexpr std::size_t kPairs = kPlaces * kPlaces;
    std::vector<DirectionPair> pairs(kPairs);
    std::vector<double> f(kPairs * channels);
    std::vector<std::uint8_t> known(kPairs);
    for (std::size_t o = begin; o < end; ++o) {
      const std::array<Vec3, kPlaces> to = places_in(table.outgoing, o);
      for (std::size_t i = 0; i < columns; ++i) {
        for (std::size_t k = 0; k < kPairs; ++k) pairs[k] = {from[i][k / kPlaces], to[k % kPlaces]};
        source.eval(pairs, f, known);
        for (std::size_t c = 0; c < channels; ++c) {
          double sum = 0;
          for (std::size_t k = 0; k < kPairs; ++k) sum += known[k] ? f[k * channels + c] : 0;
          table.values[(o * columns + i) * channels + c] = static_cast<float>(sum / kPairs);
        }
      }
    }
  });
  return table;
}

}  // namespace burnish
