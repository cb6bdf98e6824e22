#include <algorithm>
#include <cmath>
#include <vector>

#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/mirror_asymmetry.h>

namespace burnish {

double mirror_asymmetry(BrdfRef source) {
  constexpr double kFloor = 1e-3;
  constexpr std::size_t kPairs = 4000;
  const auto channels = source.channels();
  std::vector<double> f(channels), mirrored(channels);
  double sum = 0, count = 0;
  for (const auto& [wi, wo] : draw_pairs(kPairs, 1, true)) {
    if (!source.eval(wi, wo, f) || !source.eval({wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}, mirrored)) continue;
    for (std::size_t c = 0; c < channels; ++c)
      sum += 0.5 * std::abs(std::log((std::max(f[c], 0.0) + kFloor) / (std::max(mirrored[c], 0.0) + kFloor)));
    count += static_cast<double>(channels);
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace burnish
