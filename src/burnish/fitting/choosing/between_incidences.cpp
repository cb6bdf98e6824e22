// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/fitting/choosing/between_incidences.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr double kNear = radians(5);  // angle from wo to wi at samples
constexpr double kStep_deg = 2.5;     // step of theta_i of expected values
// The least distance of expected values from incidences: in degrees, and as a share of the gap.
constexpr double kApart_deg = 4, kApart = 0.25;
constexpr std::array kDistances_deg{0.0, 1.0, 2.0, 3.0, 4.5, 6.0, 8.0, 10.0};
constexpr int kSides = 5;  // azimuths of wo about wi, over half a circle

/// Returns the polar angles, in degrees, that have enough samples near wi = wo.
std::vector<double> incidences_of(const SampleSource& source) {
  struct Sum {
    double theta = 0;
    std::size_t count = 0;
  };
  std::map<long, Sum> sums;
  std::vector<DirectionPair> pairs(source.count);
  std::vector<double> weights(source.count), values(source.count * source.channels);
  source.fill(0, pairs, values, weights);
  for (std::size_t i = 0; i < source.count; ++i) {
    const auto& [wi, wo] = pairs[i];
    if (!(weights[i] > 0) || wi.z <= 0 || wo.z <= 0 || angle_between(wi, wo) > kNear) continue;
    Sum& sum = sums[std::lround(theta_of(wi) / kSameIncidence)];
    sum.theta += degrees(theta_of(wi));
    ++sum.count;
  }
  std::vector<double> found;
  for (const auto& [place, sum] : sums)
    if (sum.count >= kMinNearby) found.push_back(sum.theta / static_cast<double>(sum.count));
  return found;
}

/// Returns a pair with wi at a polar angle, and wo at a distance and an azimuth about wi.
DirectionPair pair_at(double theta_deg, double distance_deg, double azimuth) {
  const double theta = radians(theta_deg), distance = radians(distance_deg);
  const Vec3 wi = spherical_direction(theta, 0), down = spherical_direction(theta + kHalfPi, 0);
  const Vec3 aside = std::cos(azimuth) * down + std::sin(azimuth) * Vec3{0, 1, 0};
  return {wi, std::cos(distance) * wi + std::sin(distance) * aside};
}

/// Interpolates linearly between places; before the first place the value is constant.
double line_at(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (at <= x.front()) return y.front();
  const auto i = static_cast<std::size_t>(std::ranges::upper_bound(x, at) - x.begin()) - 1;
  return std::lerp(y[i], y[i + 1], (at - x[i]) / (x[i + 1] - x[i]));
}

/// True if a place is in the middle of a gap between incidences, or far enough before the first one.
bool is_apart(const std::vector<double>& incidences, double theta) {
  const auto next = std::ranges::upper_bound(incidences, theta);
  if (next == incidences.begin()) return *next - theta >= kApart_deg;
  const double low = *(next - 1), apart = std::max(kApart_deg, kApart * (*next - low));
  return theta - low >= apart && *next - theta >= apart;
}

}  // namespace

Samples between_incidences(const SampleSource& source, BrdfRef fitted) {
  Samples expected{.channels = source.channels, .isotropic = true, .pairs = {}, .values = {}};
  const std::vector<double> incidences = source.isotropic ? incidences_of(source) : std::vector<double>{};
  if (incidences.empty()) return expected;
  std::vector<double> gaps;
  for (double theta = 0; theta < incidences.back(); theta += kStep_deg)
    if (is_apart(incidences, theta)) gaps.push_back(theta);

  // For each distance and side, lines go through the logarithms at the incidences.
  std::vector<double> f(source.channels);
  for (const double distance : kDistances_deg)
    for (int k = 0; k < kSides; ++k) {
      const double azimuth = kPi * k / (kSides - 1);
      std::vector<double> known;
      std::vector<std::vector<double>> logs(source.channels);
      for (const double theta : incidences) {
        const DirectionPair pair = pair_at(theta, distance, azimuth);
        if (!fitted.eval(pair.wi, pair.wo, f) || !(std::ranges::min(f) > 0)) continue;
        known.push_back(theta);
        for (std::size_t c = 0; c < f.size(); ++c) logs[c].push_back(std::log(f[c]));
      }
      if (known.empty()) continue;
      for (const double theta : gaps) {
        const DirectionPair pair = pair_at(theta, distance, azimuth);
        if (pair.wo.z <= 0 || theta >= known.back()) continue;
        expected.pairs.push_back(pair);
        for (std::size_t c = 0; c < f.size(); ++c)
          expected.values.push_back(std::exp(line_at(known, logs[c], theta)));
      }
    }
  return expected;
}

SampleSource with_expected(const SampleSource& source, const Samples& expected, double weight) {
  SampleSource both = source;
  both.count = both.distinct = source.count + expected.size();
  both.fill = [&source, &expected, weight](std::size_t begin, std::span<DirectionPair> pairs,
                                           std::span<double> values, std::span<double> weights) {
    // The source's samples come first, then the expected ones.
    const std::size_t channels = source.channels,
                      first = begin < source.count ? std::min(pairs.size(), source.count - begin) : 0;
    if (first > 0)
      source.fill(begin, pairs.first(first), values.first(first * channels), weights.first(first));
    for (std::size_t i = first; i < pairs.size(); ++i) {
      const std::size_t other = begin + i - source.count;
      pairs[i] = expected.pairs[other];
      std::ranges::copy(expected.at(other), values.begin() + static_cast<std::ptrdiff_t>(i * channels));
      weights[i] = weight;
    }
  };
  return both;
}

}  // namespace burnish
