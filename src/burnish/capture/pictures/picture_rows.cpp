// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <fmt/format.h>
#include <png.h>

#include <burnish/capture/pictures/picture_rows.h>
#include <burnish/error.h>
#include <burnish/factors/model_file.h>
#include <burnish/file.h>
#include <burnish/math/srgb.h>

namespace burnish {

namespace {

constexpr int kMaxPictureSide = 32'768;
constexpr std::size_t kMaxHead = std::size_t{1} << 20;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& expected,
                       const std::string& found) {
  throw Error::in_file(path.string(), expected, found);
}

std::vector<std::byte> head_of(const std::filesystem::path& path, std::size_t most) {
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "a file that can be read", "none");
  std::vector<std::byte> bytes(most);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(most));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

bool is_png(std::span<const std::byte> head) {
  constexpr std::array<unsigned char, 8> kMagic{0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};
  return head.size() >= kMagic.size() && std::memcmp(head.data(), kMagic.data(), kMagic.size()) == 0;
}

/// Checks an EXR's header before OpenEXR reads it: OpenEXR allocates what an attribute's size says before it reads.
/// Every size must lie within the file, and no coordinate of its windows may exceed kMaxPictureSide.
void check_exr_head(const std::filesystem::path& path) {
  const auto size = std::filesystem::file_size(path);
  const std::vector<std::byte> head = head_of(path, std::min<std::uintmax_t>(size, kMaxHead));
  std::size_t at = 8;  // magic and version
  const auto text = [&] {
    std::string found;
    for (; at < head.size() && head[at] != std::byte{0}; ++at) found.push_back(static_cast<char>(head[at]));
    if (at++ >= head.size()) fail(path, "a whole header of an OpenEXR file", "its end");
    return found;
  };
  const auto number = [&](std::size_t where) {
    std::int32_t value;
    if (where + sizeof(value) > head.size()) fail(path, "a whole header of an OpenEXR file", "its end");
    std::memcpy(&value, head.data() + where, sizeof(value));
    return value;
  };
  constexpr std::int32_t kKnownFlags = 0x4ff;  // version 2, long names
  if (const std::int32_t version = number(4); (version & ~kKnownFlags) != 0 || (version & 0xff) != 2)
    fail(path, "an OpenEXR file of one part of scan lines", fmt::format("version and flags {:#x}", version));
  for (;;) {
    const std::string name = text();
    if (name.empty()) return;
    text();  // its type
    const std::int32_t bytes = number(at);
    at += sizeof(bytes);
    if (bytes < 0 || static_cast<std::size_t>(bytes) > head.size() - at)
      fail(path, fmt::format("attribute '{}' within the header", name), fmt::format("{} bytes", bytes));
    if (name == "dataWindow" || name == "displayWindow")
      for (std::size_t side = 0; side < 4; ++side)
        if (std::abs(std::int64_t{number(at + 4 * side)}) > kMaxPictureSide)
          fail(path, fmt::format("'{}' within {}", name, kMaxPictureSide),
               fmt::format("{}", number(at + 4 * side)));
    at += static_cast<std::size_t>(bytes);
  }
}

/// Opens an EXR for `use`, and turns OpenEXR's exceptions into Error.
template <class Use>
auto with_exr(const std::filesystem::path& path, const Use& use) {
  check_exr_head(path);
  try {
    Imf::InputFile file(path.string().c_str(), 0);
    return use(file);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {  // OpenEXR's own
    fail(path, "a whole OpenEXR picture", error.what());
  }
}

Image read_exr_rows(const std::filesystem::path& path, int first, int count) {
  return with_exr(path, [&](Imf::InputFile& file) {
    const Imath::Box2i window = file.header().dataWindow();
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    if (first < 0 || count < 1 || first + count > height)
      fail(path, fmt::format("rows {} to {}", first, first + count), fmt::format("{} rows", height));
    const Imf::ChannelList& channels = file.header().channels();
    const bool colour = channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
    if (!colour && !channels.findChannel("Y")) fail(path, "channels R, G, B or Y", "others");
    Image rows(width, count, 3);
    Imf::FrameBuffer buffer;
    constexpr std::size_t kPixel = 3 * sizeof(float);
    const std::size_t row = kPixel * static_cast<std::size_t>(width);
    for (std::size_t c = 0; c < (colour ? 3u : 1u); ++c) {
      const char* const name = colour ? std::array{"R", "G", "B"}[c] : "Y";
      const Imf::Channel& channel = *channels.findChannel(name);
      if (channel.xSampling != 1 || channel.ySampling != 1)
        fail(path, "channels without subsampling", "others");
      buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, rows.pixels.data() + c,
                                           Imath::Box2i({window.min.x, window.min.y + first},
                                                        {window.max.x, window.min.y + first + count - 1}),
                                           kPixel, row));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y + first, window.min.y + first + count - 1);
    for (std::size_t i = 0; !colour && i < rows.pixels.size(); i += 3)
      rows.pixels[i + 1] = rows.pixels[i + 2] = rows.pixels[i];
    return rows;
  });
}

constexpr std::size_t kPngHead = 8, kChunkFrame = 12;  // the signature; a chunk's length, type and sum

std::uint32_t big_endian(std::string_view four) noexcept {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(four[k]);
  return value;
}

/// Calls visit(type, content, whole chunk) for each complete chunk before the first one of picture data. Returns the
/// offset of that chunk, or of the first incomplete one.
template <class Visit>
std::size_t visit_head_chunks(std::string_view bytes, const Visit& visit) {
  std::size_t at = std::min(kPngHead, bytes.size());
  while (bytes.size() - at >= kChunkFrame) {
    const std::size_t length = big_endian(bytes.substr(at, 4));
    const std::string_view type = bytes.substr(at + 4, 4);
    if (type == "IDAT" || type == "IEND" || length > bytes.size() - at - kChunkFrame) break;
    visit(type, bytes.substr(at + 8, length), bytes.substr(at, length + kChunkFrame));
    at += length + kChunkFrame;
  }
  return at;
}

/// Returns the file without the chunks that would make libpng change its numbers.
std::string without_colour_chunks(std::string_view bytes) {
  std::string kept(bytes.substr(0, std::min(kPngHead, bytes.size())));
  const std::size_t data =
      visit_head_chunks(bytes, [&](std::string_view type, std::string_view, std::string_view chunk) {
        for (const std::string_view colour : {"gAMA", "sRGB", "cHRM", "iCCP", "cICP"})
          if (type == colour) return;
        kept += chunk;
      });
  kept += bytes.substr(data);
  return kept;
}

/// A PNG that is being read.
struct PngFile {
  png_image image{};
  std::string bytes;  // libpng reads from these

  /// Opens a PNG to read its pixels, or only its head.
  PngFile(const std::filesystem::path& path, bool pixels) {
    image.version = PNG_IMAGE_VERSION;
    if (pixels) bytes = without_colour_chunks(read_file(path).text());
    if (pixels ? !png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())
               : !png_image_begin_read_from_file(&image, path.string().c_str()))
      fail(path, "a PNG picture", image.message);
    if (image.width > static_cast<unsigned>(kMaxPictureSide) ||
        image.height > static_cast<unsigned>(kMaxPictureSide)) {
      png_image_free(&image);
      fail(path, fmt::format("sides of at most {}", kMaxPictureSide),
           fmt::format("{} x {}", image.width, image.height));
    }
  }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;
  ~PngFile() { png_image_free(&image); }
};

Image read_png_rows(const std::filesystem::path& path, int first, int count, bool srgb) {
  PngFile png(path, true);
  const int width = static_cast<int>(png.image.width), height = static_cast<int>(png.image.height);
  if (first < 0 || count < 1 || first + count > height)
    fail(path, fmt::format("rows {} to {}", first, first + count), fmt::format("{} rows", height));
  // 8 bits are read as they stand. 16 bits are read as linear values, which libpng does not change.
  const bool wide = (png.image.format & PNG_FORMAT_FLAG_LINEAR) != 0;
  png.image.format = wide ? PNG_FORMAT_LINEAR_RGB : PNG_FORMAT_RGB;
  std::vector<std::uint16_t> words(wide ? PNG_IMAGE_SIZE(png.image) / 2 : 0);
  std::vector<std::uint8_t> bytes(wide ? 0 : PNG_IMAGE_SIZE(png.image));
  const png_color black{0, 0, 0};
  if (!png_image_finish_read(&png.image, &black, wide ? static_cast<void*>(words.data()) : bytes.data(), 0,
                             nullptr))
    fail(path, "a whole PNG picture", png.image.message);
  Image rows(width, count, 3);
  const std::size_t begin = static_cast<std::size_t>(first) * static_cast<std::size_t>(width) * 3;
  for (std::size_t i = 0; i < rows.pixels.size(); ++i) {
    const float value = wide ? static_cast<float>(words[begin + i]) / 65535.0f
                             : static_cast<float>(bytes[begin + i]) / 255.0f;
    rows.pixels[i] = srgb ? srgb_decoded(value) : value;
  }
  return rows;
}

}  // namespace

PictureSize picture_size(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) fail(path, "a regular file", "none");
  const std::vector<std::byte> head = head_of(path, 16);
  if (is_png(head)) {
    const PngFile png(path, false);
    return {static_cast<int>(png.image.width), static_cast<int>(png.image.height)};
  }
  if (!looks_like_exr(head)) fail(path, "an OpenEXR or PNG picture", "other bytes");
  return with_exr(path, [&](const Imf::InputFile& file) {
    const Imath::Box2i window = file.header().dataWindow();
    return PictureSize{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1};
  });
}

StatedTransfer stated_transfer(const std::filesystem::path& path) {
  const std::vector<std::byte> head = head_of(path, kMaxHead);
  if (!is_png(head)) return StatedTransfer::none;
  StatedTransfer stated = StatedTransfer::none;
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  visit_head_chunks(text, [&](std::string_view type, std::string_view content, std::string_view) {
    if (type == "sRGB") stated = StatedTransfer::srgb;
    if (type != "gAMA" || content.size() != 4 || stated == StatedTransfer::srgb) return;
    // gAMA is in 1/100000: 1 is linear, and sRGB is written as 1 / 2.2.
    const std::uint32_t gamma = big_endian(content);
    const auto near = [&](std::uint32_t value) { return gamma + 1000 > value && gamma < value + 1000; };
    stated = near(100'000)  ? StatedTransfer::linear
             : near(45'455) ? StatedTransfer::srgb
                            : StatedTransfer::other;
  });
  return stated;
}

Image read_picture_rows(const std::filesystem::path& path, int first, int count, bool srgb) {
  return is_png(head_of(path, 16)) ? read_png_rows(path, first, count, srgb)
                                   : read_exr_rows(path, first, count);
}

std::string encode_half_exr(const Image& image) {
  if (image.channels != 3) throw Error(fmt::format("picture: expected 3 channels, found {}", image.channels));
  static constexpr float kMaxHalf = 65504;
  std::vector<Imath::half> halves(image.pixels.size());
  std::ranges::transform(image.pixels, halves.begin(),
                         [](float v) { return Imath::half(std::clamp(v, -kMaxHalf, kMaxHalf)); });
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::NO_COMPRESSION;
  Imf::FrameBuffer frame;
  constexpr std::size_t kPixel = 3 * sizeof(Imath::half);
  Imath::half* base = halves.data();
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(Imf::HALF));
    frame.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(base++), kPixel,
                                  kPixel * static_cast<std::size_t>(image.width)));
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }
  return stream.str();
}

}  // namespace burnish
