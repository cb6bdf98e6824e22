// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace burnish {

/// Pixels row by row from the top, channel fastest.
template <class T>
struct BasicImage {
  int width = 0, height = 0;
  std::size_t channels = 0;
  std::vector<T> pixels;

  BasicImage() = default;
  BasicImage(int image_width, int image_height, std::size_t image_channels)
      : width(image_width),
        height(image_height),
        channels(image_channels),
        pixels(static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height) *
               image_channels) {}

  std::size_t offset(int x, int y) const noexcept {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           channels;
  }
  /// The channels of pixel (x, y), x to the right and y downwards from the top left.
  std::span<T> at(int x, int y) noexcept { return std::span(pixels).subspan(offset(x, y), channels); }
  std::span<const T> at(int x, int y) const noexcept {
    return std::span(pixels).subspan(offset(x, y), channels);
  }

  friend bool operator==(const BasicImage&, const BasicImage&) = default;
};

/// Linear or tone-mapped values, any number of channels.
using Image = BasicImage<float>;
/// A picture as shown: sRGB bytes, 3 channels, or 4 with straight alpha.
using Image8 = BasicImage<std::uint8_t>;

}  // namespace burnish
