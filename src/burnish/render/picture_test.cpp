// SPDX-License-Identifier: Apache-2.0

#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfStdIO.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/render/picture.h>

namespace burnish {
namespace {

Image ramp() {
  Image image(64, 1, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = 0.02f * static_cast<float>(i) - 0.1f;
  return image;
}

TEST(Picture, ToneCurvesRiseFromBlackToWhite) {
  for (const Tone tone : {Tone::srgb, Tone::aces}) {
    const Image8 shown = to_bytes(ramp(), 1, tone);
    EXPECT_EQ(shown.pixels.front(), 0);
    for (std::size_t i = 1; i < shown.pixels.size(); ++i) EXPECT_GE(shown.pixels[i], shown.pixels[i - 1]);
  }
  Image grey(1, 1, 3);
  grey.pixels = {0.2158605f, 1.0f, 50.0f};  // the first is what 128 stands for
  EXPECT_EQ(to_bytes(grey, 1, Tone::srgb).pixels, (std::vector<std::uint8_t>{128, 255, 255}));
  EXPECT_LT(to_bytes(grey, 1, Tone::aces).pixels[1], 255) << "the filmic curve keeps highlights";
  EXPECT_EQ(to_bytes(grey, 0.5, Tone::srgb).pixels[1], 188);
}

TEST(Picture, AutomaticExposureLeavesTheBackgroundOut) {
  Image image(100, 1, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = i < 150 ? 9.0f : 0.25f;
  EXPECT_NEAR(automatic_exposure(image, 9), 4, 1e-6);
  EXPECT_NEAR(automatic_exposure(image, 1), 1 / 9.0, 1e-6);
  EXPECT_EQ(automatic_exposure(Image(2, 2, 3), 0), 1);
}

TEST(Picture, ExrHoldsTheValues) {
  const Image image = ramp();
  Imf::StdISStream stream;
  stream.str(encode_exr(image));
  Imf::InputFile file(stream);
  Image found(64, 1, 3);
  Imf::FrameBuffer frame;
  std::size_t c = 0;
  for (const char* name : {"R", "G", "B"})
    frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&found.pixels[c++]), 12, 12 * 64));
  file.setFrameBuffer(frame);
  file.readPixels(0, 0);
  EXPECT_EQ(found, image);
}

TEST(Picture, RefusesOtherChannels) {
  EXPECT_THROW(to_bytes(Image(2, 2, 1), 1, Tone::srgb), Error);
  EXPECT_THROW(encode_exr(Image(2, 2, 4)), Error);
  EXPECT_THROW(automatic_exposure(Image(2, 2, 1), 0), Error);
}

}  // namespace
}  // namespace burnish
