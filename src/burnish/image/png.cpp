#include <string_view>

#include <fmt/format.h>
#include <png.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/image/png.h>

namespace burnish {

std::string encode_png(const Image8& image) {
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
  return bytes;
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
