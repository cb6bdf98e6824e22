#include <algorithm>
#include <cmath>

#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/statistics.h>

namespace burnish {

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
