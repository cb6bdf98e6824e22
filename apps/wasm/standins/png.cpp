// SPDX-License-Identifier: Apache-2.0
// This file stands in for image/png.cpp. Its encoder is that of stb_image_write, which needs no other library.
#include <string_view>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/image/png.h>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace burnish {

std::string encode_png(const Image8& image, PngValues) {  // no chunk of colours is written
  if (image.channels != 3 && image.channels != 4)
    throw Error(fmt::format("a PNG has 3 or 4 channels, not {}", image.channels));
  if (image.width <= 0 || image.height <= 0) throw Error("a PNG has at least one pixel");
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, image.channels, image.pixels.data(),
                              0))
    throw Error("cannot encode a PNG");
  return bytes;
}

}  // namespace burnish
