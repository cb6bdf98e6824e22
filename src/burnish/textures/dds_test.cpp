// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/table_format.h>
#include <burnish/textures/dds.h>

namespace burnish {
namespace {

constexpr std::size_t kDdsHeader = 4 + 124 + 20;

std::uint32_t dds_word(const std::string& file, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

Texture texture_of(TableFormat format, std::size_t channels, int depth) {
  Texture texture{
      .format = format, .channels = channels, .width = 4, .height = 2, .depth = depth, .levels = {{}}};
  const std::size_t texels = 8 * static_cast<std::size_t>(std::max(depth, 1));
  for (std::size_t i = 0; i < texels * channels; ++i) texture.levels[0].push_back(static_cast<float>(i) / 64);
  return texture;
}

TEST(Dds, HoldsTexelsBehindAHeaderThatSaysWhatTheyAre) {
  struct Case {
    TableFormat format;
    std::size_t channels;
    std::uint32_t dxgi;
    std::size_t bytes;
  };
  for (const auto& [format, channels, dxgi, bytes] :
       {Case{TableFormat::half, 1, 54, 2}, Case{TableFormat::half, 3, 10, 8},
        Case{TableFormat::single, 1, 41, 4}, Case{TableFormat::single, 3, 2, 16},
        Case{TableFormat::rgb9e5, 3, 67, 4}, Case{TableFormat::unorm8, 1, 61, 1},
        Case{TableFormat::unorm8, 3, 28, 4}})
    for (const int depth : {0, 3}) {
      const std::string file = encode_dds(texture_of(format, channels, depth));
      EXPECT_EQ(file.substr(0, 4), "DDS ");
      EXPECT_EQ(dds_word(file, 4), 124u);
      EXPECT_EQ(dds_word(file, 12), 2u) << "height";
      EXPECT_EQ(dds_word(file, 16), 4u) << "width";
      EXPECT_EQ(dds_word(file, 20), 4 * bytes) << "bytes of a row";
      EXPECT_EQ(dds_word(file, 24), static_cast<std::uint32_t>(depth));
      EXPECT_EQ(file.substr(84, 4), "DX10");
      EXPECT_EQ(dds_word(file, 128), dxgi);
      EXPECT_EQ(dds_word(file, 132), depth > 0 ? 4u : 3u) << "dimensions and one";
      EXPECT_EQ(file.size(), kDdsHeader + 8 * bytes * static_cast<std::size_t>(std::max(depth, 1)));
    }
  EXPECT_THROW(encode_dds(texture_of(TableFormat::half, 2, 0)), Error);
}

TEST(Dds, HoldsValuesToTheLastBit) {
  const Texture texture = texture_of(TableFormat::single, 3, 2);
  const std::string file = encode_dds(texture);
  const auto* data = reinterpret_cast<const std::byte*>(file.data()) + kDdsHeader;
  const std::vector<float> found = unpack(TableFormat::single, 4, {data, file.size() - kDdsHeader});
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_EQ(found[i], i % 4 == 3 ? 1.0f : texture.levels[0][i / 4 * 3 + i % 4]);
}

// A face of a cube map has all its levels, the largest first, before the next face begins. Bytes of tables are above 0.
TEST(Dds, HasTheLevelsOfAFaceTogether) {
  Texture cube{
      .format = TableFormat::unorm8, .channels = 1, .width = 2, .height = 2, .faces = 6, .levels = {}};
  cube.levels.assign(2, {});
  for (std::size_t face = 0; face < 6; ++face) {
    cube.levels[0].insert(cube.levels[0].end(), 4, static_cast<float>(face + 1) / 255);
    cube.levels[1].push_back(static_cast<float>(face + 101) / 255);
  }
  const std::string file = encode_dds(cube);
  ASSERT_EQ(file.size(), kDdsHeader + 6 * 5);
  EXPECT_EQ(dds_word(file, 28), 2u);
  EXPECT_EQ(dds_word(file, 136), 4u) << "a cube map";
  for (std::size_t face = 0; face < 6; ++face)
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_EQ(static_cast<std::size_t>(file[kDdsHeader + 5 * face + i]), i < 4 ? face + 1 : face + 101);
}

TEST(Dds, HoldsBlocksAsTheyAre) {
  const std::vector<std::vector<std::byte>> levels{std::vector<std::byte>(64, std::byte{7}),
                                                   std::vector<std::byte>(16, std::byte{9})};
  const std::string file = encode_dds(StoredTexels{.format = TableFormat::half,
                                                   .blocks = TexelBlocks::bc5_snorm,
                                                   .width = 8,
                                                   .height = 8,
                                                   .levels = levels});
  EXPECT_EQ(dds_word(file, 128), 84u);
  EXPECT_EQ(dds_word(file, 20), 64u) << "bytes of the first level";
  EXPECT_EQ(file.substr(kDdsHeader), std::string(64, 7) + std::string(16, 9));
  EXPECT_THROW(encode_dds(StoredTexels{.format = TableFormat::single, .levels = levels}), Error);
}

}  // namespace
}  // namespace burnish
