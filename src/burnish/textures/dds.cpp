// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/textures/dds.h>

namespace burnish {

namespace {

/// Formats of DXGI and their sizes in bits a texel. [DDS]
struct DxgiFormat {
  std::uint32_t number, bits;
  bool blocks = false;
};

DxgiFormat dxgi_format(TableFormat format, std::size_t channels) noexcept {
  const bool one = channels == 1;
  switch (format) {
    case TableFormat::half:
      return one ? DxgiFormat{54, 16} : DxgiFormat{10, 64};
    case TableFormat::single:
      return one ? DxgiFormat{41, 32} : DxgiFormat{2, 128};
    case TableFormat::rgb9e5:
      return {67, 32};
    default:
      return one ? DxgiFormat{61, 8} : DxgiFormat{28, 32};
  }
}

struct DdsExtent {
  int width, height, depth, faces, levels;
};

void put_words(std::string& to, std::initializer_list<std::uint32_t> words) {
  for (const std::uint32_t word : words)
    for (int i = 0; i < 4; ++i) to += static_cast<char>(word >> (8 * i));
}

// The header, its flags, and what DirectX 10 added. [DDS]
std::string dds_header(const DxgiFormat& format, const DdsExtent& extent) {
  constexpr std::uint32_t kCaps = 1, kHeight = 2, kWidth = 4, kPitch = 8, kPixelFormat = 0x1000,
                          kLevels = 0x20000, kLinearSize = 0x80000, kDepth = 0x800000;
  constexpr std::uint32_t kComplex = 8, kTexture = 0x1000, kMipmap = 0x400000, kAllFaces = 0xFE00,
                          kVolume = 0x200000, kFourCc = 4, kDx10 = 0x30315844;
  const auto width = static_cast<std::uint32_t>(extent.width),
             height = static_cast<std::uint32_t>(extent.height),
             depth = static_cast<std::uint32_t>(extent.depth),
             levels = static_cast<std::uint32_t>(extent.levels);
  const bool volume = extent.depth > 0, cube = extent.faces == 6, mipmapped = extent.levels > 1;
  // Bytes of a row, or of the whole level where texels come in blocks of 4 x 4.
  const std::uint32_t pitch =
      format.blocks ? (width + 3) / 4 * ((height + 3) / 4) * 16 : (width * format.bits + 7) / 8;
  std::string text = "DDS ";
  put_words(text, {124,
                   kCaps | kHeight | kWidth | kPixelFormat | (format.blocks ? kLinearSize : kPitch) |
                       (mipmapped ? kLevels : 0) | (volume ? kDepth : 0),
                   height, width, pitch, volume ? depth : 0, levels});
  text.append(11 * 4, '\0');
  put_words(text, {32, kFourCc, kDx10, 0, 0, 0, 0, 0});
  put_words(text, {kTexture | (mipmapped || volume || cube ? kComplex : 0) | (mipmapped ? kMipmap : 0),
                   (cube ? kAllFaces : 0) | (volume ? kVolume : 0), 0, 0, 0});
  // The format, 2-D or 3-D, a cube map or not, one of them, alpha as it is.
  put_words(text, {format.number, volume ? 4U : 3U, cube ? 4U : 0U, 1, 0});
  return text;
}

}  // namespace

std::string encode_dds(const Texture& texture) {
  if (texture.channels != 1 && texture.channels != 3)
    throw Error(fmt::format("DDS: expected a texture of 1 or 3 channels, found {}", texture.channels));
  std::vector<std::string> levels;
  for (const std::vector<float>& level : texture.levels) levels.push_back(level_bytes(texture, level));
  std::string file = dds_header(
      dxgi_format(texture.format, texture.channels),
      {texture.width, texture.height, texture.depth, texture.faces, static_cast<int>(levels.size())});
  // A face has all its levels before the next face begins.
  const auto faces = static_cast<std::size_t>(texture.faces);
  for (std::size_t face = 0; face < faces; ++face)
    for (const std::string& level : levels)
      file.append(level, face * (level.size() / faces), level.size() / faces);
  return file;
}

std::string encode_dds(const StoredTexels& texels) {
  if (texels.format != TableFormat::unorm8 && texels.format != TableFormat::half)
    throw Error(fmt::format("DDS: expected bytes or halves, found {}", to_string(texels.format)));
  constexpr DxgiFormat kBc5Unorm{83, 8, true}, kBc5Snorm{84, 8, true};
  const DxgiFormat format = texels.blocks == TexelBlocks::none        ? dxgi_format(texels.format, 4)
                            : texels.blocks == TexelBlocks::bc5_snorm ? kBc5Snorm
                                                                      : kBc5Unorm;
  std::string file =
      dds_header(format, {texels.width, texels.height, 0, 1, static_cast<int>(texels.levels.size())});
  for (const std::vector<std::byte>& level : texels.levels)
    file.append(reinterpret_cast<const char*>(level.data()), level.size());
  return file;
}

}  // namespace burnish
