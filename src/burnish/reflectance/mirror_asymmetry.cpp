// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/mirror_asymmetry.h>

namespace burnish {

double mirror_asymmetry(BrdfRef source) {
  constexpr double kFloor = 1e-3;
  constexpr std::size_t kPairs = 4000;
  // Values of pairs and of their mirror images are computed many at a time, as networks are slow one by one.
  const auto channels = source.channels();
  std::vector<DirectionPair> pairs = draw_pairs(kPairs, 1, true);
  std::vector<double> f(pairs.size() * channels), mirrored(f.size());
  std::vector<std::uint8_t> known(pairs.size()), mirrored_known(pairs.size());
  source.eval(pairs, f, known);
  for (auto& [wi, wo] : pairs) {
    wi.y = -wi.y;
    wo.y = -wo.y;
  }
  source.eval(pairs, mirrored, mirrored_known);

  // The asymmetry is the mean of half of |ln(f / mirrored f)|, with a floor of 1e-3.
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!known[i] || !mirrored_known[i]) continue;
    for (std::size_t c = i * channels; c < (i + 1) * channels; ++c)
      sum += 0.5 * std::abs(std::log((std::max(f[c], 0.0) + kFloor) / (std::max(mirrored[c], 0.0) + kFloor)));
    count += static_cast<double>(channels);
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace burnish
