// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/report/factor_images.h>

namespace burnish {

Image8 factor_image(const Table& table) {
  constexpr int kTarget = 256, kBandHeight = 32;
  const int scale = std::max(1, kTarget / table.layout.width);
  const int width = scale * table.layout.width;
  const int height = table.layout.height > 1 ? scale * table.layout.height : kBandHeight;
  Image8 image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      // rows of a texture go up, rows of a picture down
      const int row = table.layout.height > 1 ? table.layout.height - 1 - y / scale : 0;
      const float* node = table.values.data() +
                          static_cast<std::size_t>(row * table.layout.width + x / scale) * table.channels;
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = node[std::min(c, table.channels - 1)];
        const double shown = std::clamp(1 - std::log2(value) / std::log2(kShownFactor), 0.0, 1.0);
        image.at(x, y)[c] = static_cast<std::uint8_t>(std::lround(255 * shown));
      }
    }
  return image;
}

}  // namespace burnish
