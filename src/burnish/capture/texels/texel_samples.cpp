// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <utility>

#include <burnish/capture/texels/texel_samples.h>

namespace burnish {

TexelSamples samples_of(CaptureRows rows) {
  TexelSamples samples{.texels = {},
                       .pictures = rows.pictures,
                       .values = std::move(rows.values),
                       .states = std::move(rows.states),
                       .directions = std::move(rows.directions)};
  for (int y = 0; y < rows.rows; ++y)
    for (int x = 0; x < rows.width; ++x) samples.texels.push_back({x, rows.first_row + y});
  return samples;
}

TexelSamples every(const TexelSamples& all, std::size_t step) {
  TexelSamples some{.texels = {}, .pictures = all.pictures, .values = {}, .states = {}};
  for (std::size_t t = 0; t < all.size(); t += step) some.texels.push_back(all.texels[t]);
  const auto append = [](auto& to, const auto& from, std::size_t pixel, std::size_t count) {
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(count * pixel);
    to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(count));
  };
  for (std::size_t p = 0; p < all.pictures; ++p)
    for (std::size_t t = 0; t < all.size(); t += step) {
      const std::size_t pixel = p * all.size() + t;
      append(some.values, all.values, pixel, 3);
      some.states.push_back(all.states[pixel]);
      if (!all.directions.empty()) append(some.directions, all.directions, pixel, 6);
    }
  return some;
}

}  // namespace burnish
