// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/image/block_compression.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

double rms_of(int width, int height, const std::vector<float>& pairs, bool has_sign) {
  const std::vector<float> again =
      decode_bc5(width, height, encode_bc5(width, height, pairs, has_sign), has_sign);
  EXPECT_EQ(again.size(), pairs.size());
  double sum = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double off = static_cast<double>(again[i]) - static_cast<double>(pairs[i]);
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

// Written out by the definition: ends 200 and 40 of all mixtures, codes 0 to 7 twice; then ends 20 and 100, which has
// 0 and 1 as codes 6 and 7.
TEST(BlockCompression, ReadsWhatTheFormatSays) {
  std::uint64_t codes = 0;
  for (std::uint64_t i = 0; i < 16; ++i) codes |= (i % 8) << (3 * i);
  std::vector<std::byte> block(16);
  for (std::size_t i = 0; i < 6; ++i) block[2 + i] = block[10 + i] = static_cast<std::byte>(codes >> (8 * i));
  block[0] = std::byte{200};
  block[1] = std::byte{40};
  block[8] = std::byte{20};
  block[9] = std::byte{100};
  const std::vector<float> pairs = decode_bc5(4, 4, block, false);
  const double first[] = {200,
                          40,
                          (6 * 200 + 40) / 7.0,
                          (5 * 200 + 2 * 40) / 7.0,
                          (4 * 200 + 3 * 40) / 7.0,
                          (3 * 200 + 4 * 40) / 7.0,
                          (2 * 200 + 5 * 40) / 7.0,
                          (200 + 6 * 40) / 7.0},
               second[] = {20,
                           100,
                           (4 * 20 + 100) / 5.0,
                           (3 * 20 + 2 * 100) / 5.0,
                           (2 * 20 + 3 * 100) / 5.0,
                           (20 + 4 * 100) / 5.0,
                           0,
                           255};
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(static_cast<double>(pairs[2 * i]), first[i % 8] / 255, 1e-6) << i;
    EXPECT_NEAR(static_cast<double>(pairs[2 * i + 1]), second[i % 8] / 255, 1e-6) << i;
  }
  block[0] = std::byte{0x80};  // -128 is -127
  EXPECT_EQ(decode_bc5(4, 4, block, true)[0], -1.0f);
}

TEST(BlockCompression, KeepsWhatBlocksCanSay) {
  // constants, two values, steps between them, and 0 and 1 beside others
  for (const bool has_sign : {false, true}) {
    const float steps = has_sign ? 127 : 255, least = has_sign ? -1 : 0;
    std::vector<float> constant(32), two(32), sparse(32);
    for (std::size_t i = 0; i < 32; ++i) {
      constant[i] = 77 / steps;
      two[i] = (i % 3 == 0 ? 12 : 90) / steps;
      sparse[i] = i % 4 == 0 ? least : i % 4 == 1 ? 1 : (i % 8 == 2 ? 30 : 55) / steps;
    }
    for (const auto& pairs : {constant, two, sparse})
      EXPECT_LT(rms_of(4, 4, pairs, has_sign), 1e-6) << has_sign;
  }
}

TEST(BlockCompression, IsAsNearAsItSays) {
  constexpr int kWidth = 61, kHeight = 34;  // no whole blocks
  Pcg32 random(3);
  std::vector<float> noise, smooth;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 2; ++c) {
        noise.push_back(static_cast<float>(random.uniform()));
        smooth.push_back(static_cast<float>(0.5 + 0.4 * std::sin(0.05 * x + c) * std::cos(0.04 * y)));
      }
  EXPECT_LT(rms_of(kWidth, kHeight, noise, false), 0.03);
  EXPECT_LT(rms_of(kWidth, kHeight, smooth, false), 0.002);
  std::vector<float> ramp;  // 0.3 in a block
  for (int i = 0; i < kWidth * kHeight; ++i)
    for (int c = 0; c < 2; ++c) ramp.push_back(static_cast<float>(std::fmod(0.1 * (i % kWidth), 0.9)));
  EXPECT_LT(rms_of(kWidth, kHeight, ramp, false), 0.04);
  for (float& value : noise) value = 2 * value - 1;
  EXPECT_LT(rms_of(kWidth, kHeight, noise, true), 0.06);
  EXPECT_EQ(decode_bc5(1, 1, encode_bc5(1, 1, std::vector{2.0f, -3.0f}, true), true),
            (std::vector{1.0f, -1.0f}));
}

TEST(BlockCompression, RefusesOtherSizes) {
  EXPECT_THROW(encode_bc5(4, 4, std::vector<float>(31), false), Error);
  EXPECT_THROW(decode_bc5(5, 4, std::vector<std::byte>(16), false), Error);
  EXPECT_THROW(encode_bc5(-4, -4, std::vector<float>(32), false), Error);
  EXPECT_EQ(decode_bc5(1, 1, encode_bc5(1, 1, std::vector{NAN, 1.0f}, false), false),
            (std::vector{0.0f, 1.0f}));
}

}  // namespace
}  // namespace burnish
