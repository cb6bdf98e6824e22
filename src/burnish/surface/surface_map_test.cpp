// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/surface/surface_map.h>
#include <burnish/testing/surfaces.h>

namespace burnish {
namespace {

TEST(SurfaceMap, StoresValuesToHalfACode) {
  const std::vector<float> values{0, 0.1f, 0.77f, 2, 1.999f, 0.003f};
  const SurfaceMap bytes(3, 2, 1, TableFormat::unorm8, 2, values),
      halves(3, 2, 1, TableFormat::half, 1, values);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) {
      const float value = values[static_cast<std::size_t>(3 * y + x)];
      EXPECT_NEAR(bytes.texel(x, y)[0], value, 1.0001 / 255);
      EXPECT_NEAR(halves.texel(x, y)[0], value, value * 0x1p-11 + 0x1p-25);
    }
}

TEST(SurfaceMap, FiltersBetweenTexelsAndRepeats) {
  const SurfaceMap map(2, 1, 1, TableFormat::half, 1, std::array{1.0f, 3.0f});
  EXPECT_FLOAT_EQ(map.sample(0.25, 0.5)[0], 1);
  EXPECT_FLOAT_EQ(map.sample(0.75, 0.5)[0], 3);
  EXPECT_FLOAT_EQ(map.sample(0.5, 0.5)[0], 2);
  EXPECT_FLOAT_EQ(map.sample(0.0, 0.5)[0], 2);  // half-way to the last texel
  EXPECT_FLOAT_EQ(map.sample(-1.75, 7.5)[0], 1);
  EXPECT_FLOAT_EQ(map.sample(0.25, 0.5, 0.5)[0], 1.5);  // half-way to the mean
  EXPECT_FLOAT_EQ(map.sample(0.25, 0.5, 9)[0], 2);
}

// Eleven texels: (7 + 1/2) / 11 rounds to what lies in the texel before.
TEST(SurfaceMap, PlacesOfTexelsAreTheTexels) {
  const SurfaceMap map = random_map(11, 7, 3, TableFormat::half, 1, 3);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 11; ++x) {
      EXPECT_EQ(map.sample(map.place_of_texel(x, y)), map.texel(x, y));
      const SurfaceMap::Value near = map.sample(map.place((x + 0.5) / 11, (y + 0.5) / 7));
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(near[c], map.texel(x, y)[c], 1e-5);
    }
}

// Every level has the mean of what it covers: to half a code a level.
TEST(SurfaceMap, LevelsKeepTheMean) {
  for (const TableFormat format : {TableFormat::unorm8, TableFormat::half}) {
    const SurfaceMap map = random_map(64, 32, 3, format, 1.5f, 9);
    ASSERT_EQ(map.levels(), 7u);
    std::array<double, 3> mean{};
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 64; ++x)
        for (std::size_t c = 0; c < 3; ++c) mean[c] += static_cast<double>(map.texel(x, y)[c]) / (64 * 32);
    const SurfaceMap::Value last = map.texel(0, 0, 6);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(static_cast<double>(last[c]), mean[c], 6 * 1.5 / 510);
  }
}

TEST(SurfaceMap, OddSidesLeaveNoTexelOut) {
  std::vector<float> values(15, 0);
  values[14] = 1;  // the last corner of 5 x 3
  const SurfaceMap map(5, 3, 1, TableFormat::half, 1, values);
  EXPECT_GT(map.texel(0, 0, map.levels() - 1)[0], 0);
}

TEST(SurfaceMap, ItsBytesAreTheMap) {
  for (const TableFormat format : {TableFormat::unorm8, TableFormat::half}) {
    const SurfaceMap map = random_map(7, 5, 2, format, format == TableFormat::half ? 1 : 0.3f, 5);
    EXPECT_EQ(SurfaceMap(7, 5, 2, format, map.scale(), map.stored_bytes()), map);
  }
}

TEST(SurfaceMap, RefusesWhatItCannotHold) {
  const std::vector<float> one{0.5f};
  const auto make = [&](int width, std::size_t channels, TableFormat format, float scale,
                        std::vector<float> values) {
    return [=] { SurfaceMap(width, 1, channels, format, scale, values); };
  };
  EXPECT_THROW(make(0, 1, TableFormat::half, 1, one)(), Error);
  EXPECT_THROW(make(1, 4, TableFormat::half, 1, {1, 1, 1, 1})(), Error);
  EXPECT_THROW(make(1, 1, TableFormat::single, 1, one)(), Error);
  EXPECT_THROW(make(1, 1, TableFormat::unorm8, 0, one)(), Error);
  EXPECT_THROW(make(1, 1, TableFormat::unorm8, 0.4f, one)(), Error);
  EXPECT_THROW(make(1, 1, TableFormat::unorm8, 1, {-0.1f})(), Error);
  EXPECT_THROW(make(1, 1, TableFormat::half, 1, {NAN})(), Error);
  EXPECT_THROW(make(2, 1, TableFormat::half, 1, one)(), Error);
  const std::array infinite{std::byte{0}, std::byte{0x7c}};
  EXPECT_THROW(SurfaceMap(1, 1, 1, TableFormat::half, 1, std::span<const std::byte>(infinite)), Error);
}

}  // namespace
}  // namespace burnish
