// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/capture/training_pixels.h>
#include <burnish/error.h>
#include <burnish/math/angles.h>

namespace burnish {
namespace {

// Flat texels under lights of many angles. The red value of a pixel is its number.
struct NumberedPixels {
  static constexpr std::size_t kTexels = 6, kPictures = 40;
  CaptureForm form{.width = kTexels, .height = 1, .normals = {}, .pictures = {}};
  TexelSamples samples;
  TexelFits fits;

  NumberedPixels() {
    for (std::size_t p = 0; p < kPictures; ++p)
      form.pictures.push_back(
          {.file = {},
           .light = {.is_direction = true, .at = spherical_direction(0.03 * static_cast<double>(p), 1)},
           .view = {.is_direction = true, .at = {0, 0, 1}},
           .mask = {},
           .held_out = p % 8 == 7});
    for (std::size_t t = 0; t < kTexels; ++t) samples.texels.push_back({static_cast<int>(t), 0});
    samples.pictures = kPictures;
    samples.states.resize(kTexels * kPictures, PixelState::there);
    for (std::size_t i = 0; i < kTexels * kPictures; ++i)
      samples.values.insert(samples.values.end(), {static_cast<float>(i + 1), 0.5f, 0.25f});
    fits.trust.resize(samples.states.size(), 1);
  }
  TrainingSet drawn(std::vector<std::size_t> texels, PixelTrust trust, std::uint64_t stream = 0) const {
    return training_pixels(
        {.samples = samples, .form = form, .exposure = 2, .fits = fits, .lobes = nullptr, .trust = trust},
        texels, 400, 1, stream);
  }
  /// Returns the number of pixel i of a set, counted as [picture][texel].
  static std::size_t number(const TrainingSet& set, std::size_t i) {
    const double red = static_cast<double>(set.values[3 * i]) * set.pairs[i].wi.z;
    return static_cast<std::size_t>(std::lround(red)) - 1;
  }
};

TEST(TrainingPixels, AreOfTheTexelsAndPicturesThatAreFitted) {
  const NumberedPixels pixels;
  const TrainingSet set = pixels.drawn({1, 4}, PixelTrust::alike);
  ASSERT_GT(set.size(), 300u);
  EXPECT_EQ(set.picture_count, (set.size() + 1) / 2);
  EXPECT_EQ(set.exposure, 2);
  std::set<std::size_t> texels, pictures;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const std::size_t number = NumberedPixels::number(set, i);
    texels.insert(number % NumberedPixels::kTexels);
    const std::size_t picture = number / NumberedPixels::kTexels;
    pictures.insert(picture);
    const CapturePicture& form = pixels.form.pictures.at(picture);
    EXPECT_FALSE(form.held_out);
    EXPECT_NEAR(set.pairs[i].wi.z, form.light.at.z, 1e-12);
    EXPECT_GT(set.weights[i], 0);
  }
  EXPECT_EQ(texels, (std::set<std::size_t>{1, 4}));
  EXPECT_GT(pictures.size(), 30u);
  // The same stream draws the same pixels, and another stream draws others.
  EXPECT_EQ(pixels.drawn({1, 4}, PixelTrust::alike).values, set.values);
  EXPECT_NE(pixels.drawn({1, 4}, PixelTrust::alike, 1).values, set.values);
}

TEST(TrainingPixels, CountAsTheyAreTrusted) {
  NumberedPixels pixels;
  for (std::size_t i = 0; i < pixels.fits.trust.size(); ++i)
    pixels.fits.trust[i] = i % 3 == 0 ? 0 : i % 3 == 1 ? 0.04f : 0.5f;
  const std::vector<std::size_t> all{0, 1, 2, 3, 4, 5};
  const auto kinds_of = [&](PixelTrust trust) {
    std::set<std::size_t> found;
    const TrainingSet set = pixels.drawn(all, trust);
    for (std::size_t i = 0; i < set.size(); ++i) found.insert(NumberedPixels::number(set, i) % 3);
    return found;
  };
  EXPECT_EQ(kinds_of(PixelTrust::alike), (std::set<std::size_t>{0, 1, 2}));
  EXPECT_EQ(kinds_of(PixelTrust::as_found), (std::set<std::size_t>{2}));
  EXPECT_EQ(kinds_of(PixelTrust::mild), (std::set<std::size_t>{1, 2}));  // pixels of trust 0 are not drawn
  // A pair's weight is 1 times its trust.
  const TrainingSet set = pixels.drawn(all, PixelTrust::as_found);
  for (std::size_t i = set.picture_count; i < set.size(); ++i) EXPECT_EQ(set.weights[i], 0.5f);
}

TEST(TrainingPixels, AreRefusedWhereThereIsNone) {
  NumberedPixels pixels;
  std::ranges::fill(pixels.samples.states, PixelState::missing);
  EXPECT_THROW(pixels.drawn({0}, PixelTrust::alike), Error);
}

}  // namespace
}  // namespace burnish
