// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <burnish/fitting/choosing/frontal_pixels.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr double kGoldenStep = 0.6180339887498949;  // step of azimuths, in turns
constexpr double kFrontalCosine = 1e-3;

}  // namespace

TrainingSet with_frontal_pixels(BrdfRef source, TrainingSet set, double share) {
  const auto count = static_cast<std::size_t>(share * static_cast<double>(set.picture_count));
  const auto channels = set.channels;

  // Low-discrepancy normals: half of them are uniform on the disk, and half have theta = pi/2 u^2.
  std::vector<DirectionPair> pairs;
  std::vector<float> weights;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(count), v = std::fmod(2 * u, 1.0),
                 phi = kTwoPi * std::fmod(static_cast<double>(i) * kGoldenStep, 1.0);
    const double theta = u < 0.5 ? std::asin(std::sqrt(v)) : kHalfPi * v * v;
    if (!(std::cos(theta) > kFrontalCosine) || !(theta > 0)) continue;
    const double even = std::sin(2 * theta), crowded = 1 / std::sqrt(kTwoPi * theta);
    const Vec3 w{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    pairs.push_back({w, w});
    weights.push_back(static_cast<float>(2 * even / (even + crowded)));
  }
  std::vector<double> values(pairs.size() * channels);
  std::vector<std::uint8_t> known(pairs.size());
  source.eval(pairs, values, known);

  // The new pixels follow the present ones.
  TrainingSet more = set;
  const auto cut = [&](auto& v, std::size_t at) {
    v.erase(v.begin() + static_cast<std::ptrdiff_t>(at), v.end());
  };
  cut(more.pairs, set.picture_count);
  cut(more.weights, set.picture_count);
  cut(more.values, set.picture_count * channels);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!known[i]) continue;
    more.pairs.push_back(pairs[i]);
    more.weights.push_back(weights[i]);
    for (std::size_t c = 0; c < channels; ++c)
      more.values.push_back(static_cast<float>(std::max(values[i * channels + c], 0.0)));
  }
  more.picture_count = more.size();
  const auto append = [](auto& to, const auto& from, std::size_t at) {
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(at), from.end());
  };
  append(more.pairs, set.pairs, set.picture_count);
  append(more.weights, set.weights, set.picture_count);
  append(more.values, set.values, set.picture_count * channels);
  return more;
}

}  // namespace burnish
