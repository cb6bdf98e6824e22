// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/statistics.h>

namespace burnish {

ReciprocityError reciprocity_error(BrdfRef source, std::size_t count, std::uint64_t seed) {
  const auto channels = source.channels();
  std::vector<DirectionPair> pairs = draw_pairs(count, seed, false);
  std::vector<double> f(pairs.size() * channels), swapped(f.size());
  std::vector<std::uint8_t> known(pairs.size()), swapped_known(pairs.size());
  source.eval(pairs, f, known);
  for (DirectionPair& pair : pairs) std::swap(pair.wi, pair.wo);
  source.eval(pairs, swapped, swapped_known);

  ReciprocityError result;
  double sum = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!known[i] || !swapped_known[i]) continue;
    ++result.pairs;
    for (std::size_t c = i * channels; c < (i + 1) * channels; ++c) {
      // The error is |f - swapped f| over the mean of both, averaged over channels and pairs.
      const double total = std::abs(f[c] + swapped[c]);
      if (total > 0) sum += 2 * std::abs(f[c] - swapped[c]) / total / static_cast<double>(channels);
    }
  }
  if (result.pairs > 0) result.mean = sum / static_cast<double>(result.pairs);
  return result;
}

}  // namespace burnish
