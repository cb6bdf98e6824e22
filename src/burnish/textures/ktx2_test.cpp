// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/testing/tools.h>
#include <burnish/textures/ktx2.h>

namespace burnish {
namespace {

struct Case {
  TableFormat format;
  std::size_t channels;
  std::uint32_t vk_format;
  std::size_t texel;
};
const Case kCases[] = {{TableFormat::half, 1, 76, 2},    {TableFormat::half, 3, 97, 8},
                       {TableFormat::single, 1, 100, 4}, {TableFormat::single, 3, 109, 16},
                       {TableFormat::rgb9e5, 3, 123, 4}, {TableFormat::unorm8, 1, 9, 1},
                       {TableFormat::unorm8, 3, 37, 4}};

Table random_table(const Case& c) {
  Pcg32 random(3);
  Table table{.name = "t",
              .layout = {.shape = TableShape::grid, .width = 7, .height = 5},
              .channels = c.channels,
              .values = {},
              .format = c.format};
  for (std::size_t i = 0; i < table.layout.node_count() * c.channels; ++i)
    table.values.push_back(static_cast<float>(random.uniform()));
  table.values = round_to_format(c.format, c.channels, table.values);
  return table;
}

std::uint64_t word(const std::string& file, std::size_t at, std::size_t bytes = 4) {
  std::uint64_t value = 0;
  std::memcpy(&value, file.data() + at, bytes);
  return value;
}

class Ktx2 : public testing::TestWithParam<std::tuple<Case, bool>> {};

TEST_P(Ktx2, HoldsTheTableToTheLastBit) {
  const auto& [c, compressed] = GetParam();
  const Table table = random_table(c);
  const std::string file = encode_ktx2(table, compressed);
  EXPECT_EQ(word(file, 12), c.vk_format);
  EXPECT_EQ(word(file, 20), 7u);
  EXPECT_EQ(word(file, 24), 5u);
  EXPECT_EQ(word(file, 44), compressed ? 2u : 0u);
  const std::size_t at = word(file, 80, 8), size = word(file, 88, 8), unpacked_size = word(file, 96, 8);
  ASSERT_EQ(at + size, file.size());
  ASSERT_EQ(unpacked_size, 35 * c.texel);
  std::string data = file.substr(at);
  if (compressed) {
    data.resize(unpacked_size);
    ASSERT_EQ(ZSTD_decompress(data.data(), data.size(), file.data() + at, size), unpacked_size);
  } else {
    EXPECT_EQ(at % c.texel, 0u);
    EXPECT_EQ(at % 4, 0u);
  }
  const auto* bytes = reinterpret_cast<const std::byte*>(data.data());
  const int stored = c.texel == texel_bytes(c.format, c.channels) ? c.channels : 4;
  const std::vector<float> values = unpack(c.format, stored, {bytes, data.size()});
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t node = i / static_cast<std::size_t>(stored),
                      channel = i % static_cast<std::size_t>(stored);
    ASSERT_EQ(values[i], channel == 3 ? 1.0f : table.values[node * c.channels + channel]);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Ktx2, testing::Combine(testing::ValuesIn(kCases), testing::Bool()),
                         [](const auto& test) {
                           const Case& c = std::get<0>(test.param);
                           return fmt::format("{}{}{}", to_string(c.format), c.channels,
                                              std::get<1>(test.param) ? "Zstandard" : "");
                         });

TEST(Ktx2File, HoldsEveryLevelOfEveryFaceTheSmallestFirst) {
  Table disk = random_table({TableFormat::half, 3, 0, 0});
  disk.layout = {.shape = TableShape::disk, .width = 8, .height = 8};
  disk.values.assign(3 * 64, 0.5f);
  disk.values[0] = 1;
  for (const bool compressed : {false, true}) {
    const Texture cube = make_cube_map(disk, 8, true);
    const std::string file = encode_ktx2(cube, compressed);
    EXPECT_EQ(word(file, 36), 6u);
    ASSERT_EQ(word(file, 40), 4u);
    std::size_t end = file.size();
    for (std::size_t l = 0; l < 4; ++l) {
      const std::size_t at = word(file, 80 + 24 * l, 8), size = word(file, 88 + 24 * l, 8);
      const std::size_t unpacked = word(file, 96 + 24 * l, 8);
      EXPECT_EQ(unpacked, 6u * 8 * (64 >> (2 * l)));
      EXPECT_EQ(at + size, end);
      EXPECT_TRUE(compressed || (size == unpacked && at % 8 == 0));
      end = at;
      std::string data = file.substr(at, size);
      if (compressed) {
        data.resize(unpacked);
        ASSERT_EQ(ZSTD_decompress(data.data(), unpacked, file.data() + at, size), unpacked);
      }
      const std::vector<float> values =
          unpack(TableFormat::half, 4, {reinterpret_cast<const std::byte*>(data.data()), unpacked});
      for (std::size_t i = 0; i < cube.levels[l].size(); ++i)
        ASSERT_EQ(values[4 * (i / 3) + i % 3], cube.levels[l][i]);
    }
  }
}

// An independent reader, where it is installed: npm install ktx-parse, NODE_PATH set.
TEST(Ktx2File, OpensInKtxParse) {
  if (std::system("node -e \"require.resolve('ktx-parse')\" >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no node with ktx-parse";
  const TemporaryFolder folder("ktx2");
  const auto path = folder.path / "table.ktx2";
  for (const Case& c : kCases)
    for (const bool compressed : {false, true}) {
      std::ofstream(path, std::ios::binary) << encode_ktx2(random_table(c), compressed);
      const std::string script = fmt::format(
          "const k = require('ktx-parse').read(new Uint8Array(require('fs').readFileSync('{}')));"
          "const d = k.dataFormatDescriptor[0];"
          "process.exit(k.vkFormat === {} && k.pixelWidth === 7 && k.pixelHeight === 5 && "
          "k.levels.length === 1 && k.levels[0].uncompressedByteLength === {} && "
          "k.supercompressionScheme === {} && d.samples.length > 0 && "
          "k.keyValue.KTXwriter === 'burnish' ? 0 : 1)",
          path.string(), c.vk_format, 35 * c.texel, compressed ? 2 : 0);
      EXPECT_EQ(std::system(fmt::format("node -e \"{}\"", script).c_str()), 0) << c.vk_format;
    }
  const std::vector<std::vector<std::byte>> levels{std::vector<std::byte>(6 * 16)};
  std::ofstream(path, std::ios::binary) << encode_ktx2(
      StoredTexels{.blocks = TexelBlocks::bc5_snorm, .width = 9, .height = 7, .levels = levels}, true);
  const std::string script = fmt::format(
      "const k = require('ktx-parse').read(new Uint8Array(require('fs').readFileSync('{}')));"
      "const d = k.dataFormatDescriptor[0];"
      "process.exit(k.vkFormat === 142 && k.levels[0].uncompressedByteLength === 96 && d.colorModel === 132 "
      "&& "
      "d.samples.length === 2 && d.samples[1].bitOffset === 64 && d.samples[1].bitLength === 63 ? 0 : 1)",
      path.string());
  EXPECT_EQ(std::system(fmt::format("node -e \"{}\"", script).c_str()), 0);
}

TEST(Ktx2File, SaysWhatBlocksOfPairsAre) {
  const std::vector<std::vector<std::byte>> levels{std::vector<std::byte>(6 * 16),
                                                   std::vector<std::byte>(16)};
  for (const TexelBlocks blocks : {TexelBlocks::bc5_unorm, TexelBlocks::bc5_snorm}) {
    const bool has_sign = blocks == TexelBlocks::bc5_snorm;
    const std::string file =
        encode_ktx2(StoredTexels{.blocks = blocks, .width = 9, .height = 7, .levels = levels}, false);
    const auto word = [&](std::size_t at) {
      std::uint32_t value;
      std::memcpy(&value, &file[at], sizeof value);
      return value;
    };
    EXPECT_EQ(word(12), has_sign ? 142u : 141u);
    EXPECT_EQ(word(16), 1u);  // size of a type
    // the descriptor [DataFormat]: model 132, blocks of 4 x 4, 16 bytes, two samples of 64 bits
    const std::size_t descriptor = word(48) + 4;
    EXPECT_EQ(file[descriptor + 8], static_cast<char>(132));
    EXPECT_EQ(word(descriptor + 12), 0x0303u);
    EXPECT_EQ(word(descriptor + 16), 16u);
    const std::uint32_t qualifiers = has_sign ? 0x40000000 : 0;
    EXPECT_EQ(word(descriptor + 24), 0x003F0000u | qualifiers);
    EXPECT_EQ(word(descriptor + 40), 0x013F0040u | qualifiers);
    EXPECT_EQ(word(descriptor + 32), has_sign ? 0x80000000u : 0u);
    EXPECT_EQ(word(descriptor + 36), has_sign ? 0x7FFFFFFFu : 0xFFFFFFFFu);
  }
}

TEST(Ktx2File, HasOneOrThreeChannels) {
  EXPECT_THROW(encode_ktx2(random_table({TableFormat::half, 2, 0, 0}), false), Error);
}

}  // namespace
}  // namespace burnish
