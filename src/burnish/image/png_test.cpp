// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/image/png.h>
#include <burnish/math/random.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

Image8 random_image(int width, int height, std::size_t channels) {
  Image8 image(width, height, channels);
  Pcg32 random(7);
  for (auto& value : image.pixels) value = static_cast<std::uint8_t>(random.next() & 255);
  return image;
}

TEST(Png, RoundTripsEveryByte) {
  for (const std::size_t channels : {3, 4}) {
    const Image8 image = random_image(37, 11, channels);
    EXPECT_EQ(decode_png(encode_png(image), "memory"), image) << channels << " channels";
  }
}

// Readers that know colours would decode linear numbers whose file calls them sRGB.
TEST(Png, SaysNothingOfLinearNumbers) {
  const Image8 image = random_image(37, 11, 3);
  const std::string linear = encode_png(image, PngValues::linear);
  for (const char* chunk : {"sRGB", "gAMA", "cHRM", "iCCP"})
    EXPECT_EQ(linear.find(chunk), linear.npos) << chunk;
  EXPECT_NE(encode_png(image).find("sRGB"), linear.npos);
  EXPECT_EQ(decode_png(linear, "memory"), image);
}

TEST(Png, RoundTripsThroughAFileAndLeavesNothingElse) {
  const TemporaryFolder folder("png");
  const Image8 image = random_image(5, 3, 3);
  write_png(folder.path / "a.png", image);
  EXPECT_EQ(read_png(folder.path / "a.png"), image);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path), {}), 1);
}

TEST(Png, RefusesEveryTruncation) {
  const std::string bytes = encode_png(random_image(9, 4, 3));
  constexpr std::size_t kTrailer = 12;  // the IEND chunk carries no pixels, libpng does not miss it
  for (std::size_t size = 0; size < bytes.size() - kTrailer; ++size)
    EXPECT_THROW(decode_png(bytes.substr(0, size), "cut.png"), Error) << size << " bytes";
}

TEST(Png, RefusesImagesWithoutPixelsOrWithOddChannelCounts) {
  EXPECT_THROW(encode_png(Image8(0, 4, 3)), Error);
  EXPECT_THROW(encode_png(Image8(4, 4, 2)), Error);
}

TEST(Png, RefusesAHeaderThatClaimsTooManyPixelsBeforeAllocating) {
  std::string bytes = encode_png(random_image(2, 2, 3));
  // width and height stand big-endian at byte 16; their checksum no longer fits either
  bytes[16] = bytes[20] = 0x7f;
  EXPECT_THROW(decode_png(bytes, "huge.png"), Error);
}

}  // namespace
}  // namespace burnish
