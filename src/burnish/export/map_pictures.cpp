// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <burnish/export/map_pictures.h>

namespace burnish {

Image map_picture(const SurfaceMap& map, bool normals) {
  Image image(map.width(), map.height(), 3);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      SurfaceMap::Value value = map.texel(x, y);
      if (map.channels() == 1) value.fill(value[0]);
      if (normals) value[2] = std::sqrt(std::max(0.0f, 1 - value[0] * value[0] - value[1] * value[1]));
      std::ranges::copy(value, image.at(x, y).begin());
    }
  return image;
}

Image8 vector_bytes(const Image& vectors) {
  Image8 bytes(vectors.width, vectors.height, 3);
  std::ranges::transform(vectors.pixels, bytes.pixels.begin(), [](float x) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(0.5f * (x + 1), 0.0f, 1.0f)));
  });
  return bytes;
}

}  // namespace burnish
