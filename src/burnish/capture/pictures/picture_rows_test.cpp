// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/baselines/node_table.h>
#include <burnish/capture/pictures/picture_rows.h>
#include <burnish/error.h>
#include <burnish/image/png.h>
#include <burnish/math/srgb.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

constexpr int kAcross = 5, kDown = 4;

// Reads any rows and compares them with the whole; value_of(i) is value number i.
template <class Value>
void expect_rows(const std::filesystem::path& path, bool srgb, Value value_of) {
  for (int first = 0; first < kDown; ++first)
    for (int count = 1; first + count <= kDown; ++count) {
      const Image rows = read_picture_rows(path, first, count, srgb);
      ASSERT_EQ(rows.width, kAcross);
      ASSERT_EQ(rows.height, count);
      ASSERT_EQ(rows.pixels.size(), static_cast<std::size_t>(3 * kAcross * count));
      for (std::size_t i = 0; i < rows.pixels.size(); ++i)
        EXPECT_FLOAT_EQ(rows.pixels[i], value_of(static_cast<std::size_t>(3 * kAcross * first) + i))
            << first << " " << count;
    }
  for (const auto& [first, count] : {std::pair(-1, 2), {0, 0}, {0, kDown + 1}, {kDown, 1}})
    EXPECT_THROW(read_picture_rows(path, first, count, srgb), Error) << first << " " << count;
}

TEST(PictureRows, OfAnExrAreItsHalves) {
  const TemporaryFolder folder("picture_rows_exr");
  const auto path = folder.path / "a.exr";
  Image image(kAcross, kDown, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.1f * static_cast<float>(i) - 1;
  image.pixels[4] = 1e6f;
  image.pixels[5] = -1e6f;
  write(path, encode_half_exr(image));
  const PictureSize size = picture_size(path);
  EXPECT_EQ(size.width, kAcross);
  EXPECT_EQ(size.height, kDown);
  for (const bool srgb : {false, true})  // which only PNG uses
    expect_rows(path, srgb, [&](std::size_t i) {
      return i == 4 ? 65504.0f : i == 5 ? -65504.0f : round_to_half(image.pixels[i]);
    });
  EXPECT_THROW(encode_half_exr(Image(2, 2, 1)), Error);
}

TEST(PictureRows, OfAPngAreLinearWhicheverItsBytesAre) {
  const TemporaryFolder folder("picture_rows_png");
  const auto path = folder.path / "a.png";
  Image8 image(kAcross, kDown, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<std::uint8_t>(4 * i + 3);
  write(path, encode_png(image));
  const PictureSize size = picture_size(path);
  EXPECT_EQ(size.width, kAcross);
  EXPECT_EQ(size.height, kDown);
  const auto share = [&](std::size_t i) { return static_cast<float>(image.pixels[i]) / 255; };
  expect_rows(path, false, share);
  expect_rows(path, true, [&](std::size_t i) { return srgb_decoded(share(i)); });
}

TEST(PictureRows, RefuseWhatIsNoPicture) {
  const TemporaryFolder folder("picture_rows_bad");
  const auto path = folder.path / "a.exr";
  EXPECT_THROW(picture_size(path), Error);
  EXPECT_THROW(picture_size(folder.path), Error);
  for (const char* bytes : {"", "P6 1 1 255 ", "\x89PNG\r\n\x1a\n"}) {
    write(path, bytes);
    EXPECT_THROW(picture_size(path), Error);
    EXPECT_THROW(read_picture_rows(path, 0, 1, false), Error);
  }
}

}  // namespace
}  // namespace burnish
