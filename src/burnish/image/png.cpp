// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <png.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/image/png.h>

namespace burnish {

namespace {

// Returns a PNG without the first chunk of that type. A chunk is its length, type, content and checksum.
std::string without_chunk(std::string png, std::string_view type) {
  constexpr std::size_t kSignature = 8, kAround = 12;
  for (std::size_t at = kSignature; at + kAround <= png.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(png[at + i]);
    if (png.compare(at + 4, 4, type) == 0) return png.erase(at, length + kAround);
    at += length + kAround;
  }
  return png;
}

}  // namespace

std::string encode_png(const Image8& image, PngValues values) {
  if (image.channels != 3 && image.channels != 4)
    throw Error(fmt::format("a PNG has 3 or 4 channels, not {}", image.channels));
  if (image.width <= 0 || image.height <= 0) throw Error("a PNG has at least one pixel");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = image.channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr))
    throw Error(fmt::format("cannot encode a PNG: {}", png.message));
  bytes.resize(size);
  return values == PngValues::linear ? without_chunk(std::move(bytes), "sRGB") : bytes;
}

Image8 decode_png(const std::string& bytes, const std::string& name) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()))
    throw Error::in_file(name, "a PNG image", png.message);
  constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;
  if (std::uint64_t{png.width} * png.height > kMaxPixels) {
    const auto found = fmt::format("{} x {}", png.width, png.height);
    png_image_free(&png);
    throw Error::in_file(name, "a PNG of at most 2^28 pixels", found);
  }
  const bool alpha = (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  png.format = alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  Image8 image(static_cast<int>(png.width), static_cast<int>(png.height), alpha ? 4 : 3);
  if (!png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr))
    throw Error::in_file(name, "a whole PNG image", png.message);
  return image;
}

void write_png(const std::filesystem::path& path, const Image8& image) {
  write_then_rename(path, encode_png(image));
}

Image8 read_png(const std::filesystem::path& path) {
  const FileBytes file = read_file(path);
  return decode_png(std::string(file.text()), file.name);
}

}  // namespace burnish
