// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <zstd.h>

#include <burnish/error.h>
#include <burnish/textures/ktx2.h>

namespace burnish {

namespace {

// [KTX2, 2.1]
constexpr std::string_view kIdentifier{"\xABKTX 20\xBB\r\n\x1A\n", 12};
constexpr std::uint32_t kZstandard = 2;
constexpr std::size_t kHeaderSize = 80, kLevelSize = 24;

/// Channel types of a data format descriptor's samples.
constexpr std::uint32_t kAlpha = 15, kExponent = 0x20, kSigned = 0x40, kSignedFloat = 0xC0;
/// Its colour models.
constexpr std::uint32_t kRgbsda = 1, kBc5 = 132;

struct ChannelSample {
  std::uint32_t bit_offset, bits, channel_type, lower, upper;
};

struct Texels {
  std::uint32_t vk_format, type_size;
  std::size_t bytes;  // of a texel, or of a block
  std::vector<ChannelSample> samples;
  std::uint32_t model = kRgbsda, side = 1;  // of a block
};

// Pairs in blocks of 4 x 4.
Texels blocks_of(bool has_sign) {
  const std::uint32_t qualifiers = has_sign ? kSigned : 0, lower = has_sign ? 0x80000000 : 0,
                      upper = has_sign ? 0x7FFFFFFF : 0xFFFFFFFF;
  Texels texels{has_sign ? 142U : 141U, 1, 16, {}, kBc5, 4};
  for (std::uint32_t c = 0; c < 2; ++c) texels.samples.push_back({64 * c, 64, c | qualifiers, lower, upper});
  return texels;
}

Texels texels_of(TableFormat format, std::size_t channels) {
  if (format == TableFormat::rgb9e5) {
    Texels texels{123, 4, 4, {}};
    for (std::uint32_t c = 0; c < 3; ++c) {
      texels.samples.push_back({9 * c, 9, c, 0, 8448});
      texels.samples.push_back({27, 5, c | kExponent, 15, 31});
    }
    return texels;
  }
  const auto pick = [&](std::uint32_t one, std::uint32_t four) { return channels == 1 ? one : four; };
  const std::uint32_t stored = pick(1, 4);
  const std::uint32_t size = format == TableFormat::half ? 2 : format == TableFormat::single ? 4 : 1;
  Texels texels{format == TableFormat::half     ? pick(76, 97)
                : format == TableFormat::single ? pick(100, 109)
                                                : pick(9, 37),
                size,
                std::size_t{size} * stored,
                {}};
  for (std::uint32_t c = 0; c < stored; ++c) {
    const std::uint32_t channel = c == 3 ? kAlpha : c;
    if (size == 1)
      texels.samples.push_back({8 * c, 8, channel, 0, 255});
    else  // -1 and 1 as floats
      texels.samples.push_back({8 * size * c, 8 * size, channel | kSignedFloat, 0xBF800000, 0x3F800000});
  }
  return texels;
}

void put(std::string& to, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i));
}

void pad(std::string& to, std::size_t multiple) {
  while (to.size() % multiple) to += '\0';
}

// The basic block of a data format descriptor. [KTX2, 5]
std::string descriptor(const Texels& texels, bool compressed) {
  const std::size_t block = 24 + 16 * texels.samples.size();
  std::string text;
  put(text, 4 + block, 4);
  put(text, 0, 4);  // Khronos, basic
  put(text, 2, 2);  // version 1.3
  put(text, block, 2);
  put(text, 0x00010100 | texels.model, 4);  // BT.709, linear, no flags
  put(text, (texels.side - 1) * 0x101, 4);
  put(text, compressed ? 0 : texels.bytes, 8);
  for (const ChannelSample& s : texels.samples) {
    put(text, s.bit_offset, 2);
    put(text, s.bits - 1, 1);
    put(text, s.channel_type, 1);
    put(text, 0, 4);
    put(text, s.lower, 4);
    put(text, s.upper, 4);
  }
  return text;
}

std::string key_value(std::string_view key, std::string_view value) {
  std::string text;
  put(text, key.size() + value.size() + 2, 4);
  text.append(key).append(1, '\0').append(value).append(1, '\0');
  pad(text, 4);
  return text;
}

std::string compress(const std::string& data) {
  std::string packed(ZSTD_compressBound(data.size()), '\0');
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), data.data(), data.size(), 19);
  if (ZSTD_isError(size))
    throw Error(fmt::format("KTX2: expected data that can be compressed, found {}", ZSTD_getErrorName(size)));
  packed.resize(size);
  return packed;
}

struct Extent {
  int width, height, depth, faces;
};

std::string encoded(const Texels& texels, const Extent& extent, const std::vector<std::string>& unpacked,
                    bool compressed) {
  const std::string format = descriptor(texels, compressed), notes = key_value("KTXwriter", "burnish");
  const std::size_t levels = unpacked.size();
  const std::size_t format_at = kHeaderSize + levels * kLevelSize, notes_at = format_at + format.size();
  const std::size_t alignment = compressed ? 1 : std::max<std::size_t>(texels.bytes, 4);

  // the smallest level comes first
  struct LevelPlace {
    std::size_t at, size, unpacked;
  };
  std::vector<LevelPlace> places(levels);
  std::string data;
  const std::size_t head = (notes_at + notes.size() + alignment - 1) / alignment * alignment;
  for (std::size_t l = levels; l-- > 0;) {
    const std::string level = compressed ? compress(unpacked[l]) : unpacked[l];
    pad(data, alignment);
    places[l] = {head + data.size(), level.size(), unpacked[l].size()};
    data += level;
  }

  // header, index of the levels, descriptor, notes, levels [KTX2, 3]
  std::string file(kIdentifier);
  const std::size_t words[] = {texels.vk_format,
                               texels.type_size,
                               static_cast<std::size_t>(extent.width),
                               static_cast<std::size_t>(extent.height),
                               static_cast<std::size_t>(extent.depth),
                               0,  // layers
                               static_cast<std::size_t>(extent.faces),
                               levels,
                               compressed ? kZstandard : 0,
                               format_at,
                               format.size(),
                               notes_at,
                               notes.size()};
  for (const std::size_t word : words) put(file, word, 4);
  put(file, 0, 8);  // no global data
  put(file, 0, 8);
  for (const LevelPlace& place : places)
    for (const std::size_t word : {place.at, place.size, place.unpacked}) put(file, word, 8);
  file += format + notes;
  pad(file, alignment);
  return file + data;
}

}  // namespace

std::string encode_ktx2(const Texture& texture, bool compressed) {
  if (texture.channels != 1 && texture.channels != 3)
    throw Error(fmt::format("KTX2: expected a texture of 1 or 3 channels, found {}", texture.channels));
  std::vector<std::string> levels;
  for (const std::vector<float>& level : texture.levels) levels.push_back(level_bytes(texture, level));
  return encoded(texels_of(texture.format, texture.channels),
                 {texture.width, texture.height, texture.depth, texture.faces}, levels, compressed);
}

std::string encode_ktx2(const StoredTexels& texels, bool compressed) {
  if (texels.format != TableFormat::unorm8 && texels.format != TableFormat::half)
    throw Error(fmt::format("KTX2: expected bytes or halves, found {}", to_string(texels.format)));
  std::vector<std::string> levels;
  for (const std::vector<std::byte>& level : texels.levels)
    levels.emplace_back(reinterpret_cast<const char*>(level.data()), level.size());
  const Texels form = texels.blocks == TexelBlocks::none ? texels_of(texels.format, 4)
                                                         : blocks_of(texels.blocks == TexelBlocks::bc5_snorm);
  return encoded(form, {texels.width, texels.height, 0, 1}, levels, compressed);
}

std::string encode_ktx2(const Table& table, bool compressed) {
  return encode_ktx2(make_texture(table, false), compressed);
}

}  // namespace burnish
