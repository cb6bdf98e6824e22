// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/table_format.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

constexpr std::array kFormats{TableFormat::half, TableFormat::single, TableFormat::rgb9e5,
                              TableFormat::unorm8};

// Values over 30 octaves below 1, texels of three channels that differ by up to 2^30, and the corners.
std::vector<float> random_values(std::size_t texels) {
  Pcg32 random(3);
  std::vector<float> values;
  for (std::size_t i = 0; i < 3 * texels; ++i)
    values.push_back(static_cast<float>(std::exp2(-30 * random.uniform())));
  for (const float v : {1.0f, 0x1p-24f, 0x1.fffffep-1f, 1.0f, 511.5f / 512, 510.5f / 512, 1e-38f, 1e-45f,
                        1.0f, 0x1p-25f, 0x1p-14f, 0x1.ffcp-15f})
    values.push_back(v);
  return values;
}

float most_of(const float* texel) {
  return std::max({texel[0], texel[1], texel[2]});
}

// Bits of the packed word of one texel.
std::uint32_t rgb9e5_word(std::array<float, 3> rgb) {
  const std::vector<std::byte> bytes = pack(TableFormat::rgb9e5, 3, rgb);
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data(), sizeof(word));
  return word;
}

TEST(TableFormat, NamesReadBack) {
  for (const TableFormat format : kFormats) EXPECT_EQ(parse_table_format(to_string(format)), format);
  for (const char* name : {"", "Half", "single", "rgb9e5 ", "unorm16"})
    EXPECT_THROW(parse_table_format(name), Error) << name;
}

TEST(TableFormat, PackedSizesAreTheStatedOnes) {
  const std::vector<float> values = random_values(10);
  for (const TableFormat format : kFormats)
    EXPECT_EQ(pack(format, 3, values).size(), texel_bytes(format, 3) * values.size() / 3);
  EXPECT_EQ(texel_bytes(TableFormat::half, 3), 6u);
  EXPECT_EQ(texel_bytes(TableFormat::single, 1), 4u);
  EXPECT_EQ(texel_bytes(TableFormat::rgb9e5, 3), 4u);
  EXPECT_EQ(texel_bytes(TableFormat::unorm8, 31), 31u);
  EXPECT_FALSE(holds_channels(TableFormat::rgb9e5, 1));
}

TEST(TableFormat, RoundingKeepsValuesPositiveAndIsIdempotent) {
  const std::vector<float> values = random_values(5000);
  for (const TableFormat format : kFormats) {
    const std::vector<float> once = round_to_format(format, 3, values);
    for (const float v : once) EXPECT_GT(v, 0);
    EXPECT_EQ(round_to_format(format, 3, once), once) << to_string(format);
    EXPECT_EQ(pack(format, 3, once), pack(format, 3, values)) << to_string(format);
  }
}

TEST(TableFormat, RoundingStaysWithinTheStatedBounds) {
  const std::vector<float> values = random_values(20'000);
  const auto rounded = [&](TableFormat format) { return round_to_format(format, 3, values); };
  EXPECT_EQ(rounded(TableFormat::single), values);
  const std::vector<float> half = rounded(TableFormat::half), rgb9e5 = rounded(TableFormat::rgb9e5),
                           unorm8 = rounded(TableFormat::unorm8);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float v = values[i];
    if (v >= 0x1p-14f) {
      EXPECT_LE(std::abs(half[i] - v), 0x1p-11f * v) << v;
    }
    if (v >= 0x1p-24f) {
      EXPECT_LE(std::abs(half[i] - v), std::max(0x1p-11f * v, 0x1p-25f)) << v;
    }
    const float most = most_of(&values[i / 3 * 3]);
    const float smallest = std::max(0x1p-24f, most / 511);  // mantissa 1
    if (v >= smallest) {
      EXPECT_LE(std::abs(rgb9e5[i] - v), std::max(most / 511, 0x1p-25f)) << v;
    }
    EXPECT_LE(rgb9e5[i], std::max(v + std::max(most / 511, 0x1p-25f), 2 * smallest));
    if (v >= 1.0f / 255) {
      EXPECT_LE(std::abs(unorm8[i] - v), (1 + 1e-6f) / 510) << v;
    }
    EXPECT_GE(unorm8[i], 1.0f / 255);
  }
}

TEST(TableFormat, EveryHalfAndEveryByteIsRestored) {
  std::vector<std::byte> halves, bytes;
  for (std::uint32_t bits = 1; bits < 0x7c00; ++bits)
    for (int k = 0; k < 2; ++k) halves.push_back(static_cast<std::byte>(bits >> (8 * k)));
  for (int b = 1; b < 256; ++b) bytes.push_back(static_cast<std::byte>(b));
  EXPECT_EQ(pack(TableFormat::half, 1, unpack(TableFormat::half, 1, halves)), halves);
  EXPECT_EQ(pack(TableFormat::unorm8, 1, unpack(TableFormat::unorm8, 1, bytes)), bytes);
}

TEST(TableFormat, EveryValueIsRoundedToTheNearest) {
  // Halfway between neighbours, and a little to either side.
  for (int b = 1; b < 255; ++b) {
    const float below = static_cast<float>(b) / 255.0f, above = static_cast<float>(b + 1) / 255.0f;
    const float middle = 0.5f * (below + above);
    const std::array<float, 2> near{middle * (1 - 1e-5f), middle * (1 + 1e-5f)};
    EXPECT_EQ(round_to_format(TableFormat::unorm8, 1, near), (std::vector<float>{below, above}));
  }
  // rgb9e5: no mantissa at the exponent chosen is nearer
  const std::vector<float> values = random_values(5000);
  const std::vector<float> rounded = round_to_format(TableFormat::rgb9e5, 3, values);
  for (std::size_t i = 0; i < values.size(); i += 3) {
    const std::uint32_t word = rgb9e5_word({values[i], values[i + 1], values[i + 2]});
    const float step = std::ldexp(1.0f, static_cast<int>(word >> 27) - 24);
    for (std::size_t c = i; c < i + 3; ++c)
      EXPECT_LE(std::abs(rounded[c] - values[c]), std::max(0.5f * step, step - values[c]));
  }
}

TEST(TableFormat, SharedExponentsAreThoseOfTheGraphicsInterfaces) {
  // 1 = 256 * 2^(16 - 15 - 9); the smallest mantissa and the smallest value; the largest value, 511 * 2^7
  EXPECT_EQ(rgb9e5_word({1, 1, 1}), 16u << 27 | 256u << 18 | 256u << 9 | 256u);
  EXPECT_EQ(rgb9e5_word({1, 0.5f, 1e-6f}), 16u << 27 | 1u << 18 | 128u << 9 | 256u);
  EXPECT_EQ(rgb9e5_word({0x1p-24f, 0x1p-24f, 1e-30f}), 0u << 27 | 1u << 18 | 1u << 9 | 1u);
  EXPECT_EQ(rgb9e5_word({1e9f, 1, 65408}), 31u << 27 | 511u << 18 | 1u << 9 | 511u);
  // 511.5 / 512 would need a mantissa of 512: the exponent grows
  EXPECT_EQ(rgb9e5_word({511.5f / 512, 0.25f, 0.25f}), 16u << 27 | 64u << 18 | 64u << 9 | 256u);
}

}  // namespace
}  // namespace burnish
