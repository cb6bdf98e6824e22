// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>

namespace burnish {

namespace {

constexpr double kMinHeight = 1.5;
constexpr double kTilts_deg[] = {20, 30, 40, 50, 60};
constexpr double kNear_deg[] = {0.25, 0.75}, kRing_deg[] = {10, 12, 14};
constexpr int kRetroAzimuths = 8;

// A lobe about wi = wo is looked for up to the first of these theta_d that has enough samples at an incidence. It is
// compared with a ring between kRetroRingLow and kRetroRingHigh times that theta_d, and has to be kMinRatio times as
// high.
constexpr std::array kRetroNear{radians(1.5), radians(3), radians(5)};
constexpr double kRetroRingLow = 8.0 / 3, kRetroRingHigh = 16.0 / 3;
constexpr double kMinTilt = radians(10);  // the half vector's; the highlight lies at the normal
constexpr double kMinRatio = 2;

/// Returns the mean over channels and azimuths at some theta_d; nothing if a value is not known.
template <class Angles>
std::optional<double> mean_at(BrdfRef source, double theta_h, const Angles& theta_d_deg) {
  std::vector<double> f(source.channels());
  double sum = 0;
  for (const double angle_deg : theta_d_deg)
    for (int i = 0; i < kRetroAzimuths; ++i) {
      const auto [wi, wo] =
          from_half_diff({theta_h, 0, radians(angle_deg), kTwoPi * (i + 0.5) / kRetroAzimuths});
      if (!source.eval(wi, wo, f)) return {};
      for (const double value : f) sum += value;
    }
  return sum / (static_cast<double>(std::size(theta_d_deg) * f.size()) * kRetroAzimuths);
}

}  // namespace

bool backscatters(BrdfRef source) {
  if (!source.isotropic()) return false;
  int known = 0, higher = 0;
  for (const double tilt_deg : kTilts_deg) {
    const auto near = mean_at(source, radians(tilt_deg), kNear_deg),
               ring = mean_at(source, radians(tilt_deg), kRing_deg);
    if (!near || !ring) continue;
    ++known;
    higher += *near > kMinHeight * *ring;
  }
  return 2 * higher > known;
}

bool backscatters(const SampleSource& source) {
  // Sums of values near wi = wo and around it, for each incidence and each reach.
  struct Sums {
    double near = 0, ring = 0;
    std::size_t near_count = 0, ring_count = 0;
  };
  std::map<long, std::array<Sums, kRetroNear.size()>> incidences;
  std::vector<DirectionPair> pairs(source.count);
  std::vector<double> weights(source.count);
  std::vector<double> values(source.count * source.channels);
  source.fill(0, pairs, values, weights);
  for (std::size_t i = 0; i < source.count; ++i) {
    const auto& [wi, wo] = pairs[i];
    if (!(weights[i] > 0) || wi.z <= 0 || wo.z <= 0 || theta_of(half_vector(wi, wo)) < kMinTilt) continue;
    const double theta_d = angle_between(wi, wo) / 2, f = std::max(values[i * source.channels], 0.0);
    auto& of_incidence = incidences[std::lround(theta_of(wi) / kSameIncidence)];
    for (std::size_t k = 0; k < kRetroNear.size(); ++k) {
      Sums& sums = of_incidence[k];
      if (theta_d <= kRetroNear[k]) {
        sums.near += f;
        ++sums.near_count;
      } else if (theta_d >= kRetroRingLow * kRetroNear[k] && theta_d <= kRetroRingHigh * kRetroNear[k]) {
        sums.ring += f;
        ++sums.ring_count;
      }
    }
  }

  // The majority of the incidences with enough samples decides.
  std::size_t higher = 0, known = 0;
  for (const auto& [place, reaches] : incidences) {
    const auto sums = std::ranges::find_if(
        reaches, [](const Sums& s) { return s.near_count >= kMinNearby && s.ring_count >= kMinNearby; });
    if (sums == reaches.end()) continue;
    ++known;
    higher += sums->near / static_cast<double>(sums->near_count) >
              kMinRatio * sums->ring / static_cast<double>(sums->ring_count);
  }
  return 2 * higher > known;
}

}  // namespace burnish
