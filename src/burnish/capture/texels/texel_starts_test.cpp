// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include <burnish/capture/texels/texel_starts.h>

namespace burnish {
namespace {

TEST(Exposure, IsOfWhatIsFittedAndThere) {
  constexpr std::size_t kTexels = 100;
  CaptureForm form{.width = kTexels, .height = 1, .normals = {}, .pictures = {}};
  form.pictures.resize(2);
  form.pictures[1].held_out = true;
  TexelSamples samples{.texels = std::vector<std::array<int, 2>>(kTexels + 1),
                       .pictures = 2,
                       .values = {},
                       .states = std::vector<PixelState>(2 * (kTexels + 1), PixelState::there)};
  for (std::size_t t = 0; t < kTexels; ++t)
    samples.values.insert(samples.values.end(), 3, static_cast<float>(t + 1) / 100);
  samples.values.insert(samples.values.end(), 3, 100.0f);
  samples.states[kTexels] = PixelState::missing;
  samples.values.insert(samples.values.end(), 3 * (kTexels + 1), 100.0f);  // held out
  // There are three values of each; place 0.97 * 299 = 290.03 lies between the last 0.97 and the first 0.98.
  EXPECT_NEAR(exposure_of(samples, form), 1 / 0.9703, 1e-6);
  std::ranges::fill(samples.values, 0.0f);
  EXPECT_EQ(exposure_of(samples, form), 1);
}

TEST(GeneralLobes, AreEachOfOneChannel) {
  const FactoredBrdf lobes = general_lobes();
  ASSERT_EQ(lobes.channels(), 3u);
  std::array<int, 3> of{};
  for (const Lobe& lobe : lobes.lobes()) {
    int lit = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      lit += lobe.scale[c] > 0;
      of[c] += lobe.scale[c] > 0;
    }
    EXPECT_EQ(lit, 1);
  }
  EXPECT_EQ(of[0], of[1]);
  EXPECT_EQ(of[0], of[2]);
  EXPECT_LE(lobes.lobes().size(), kMaxSurfaceLobes);
}

}  // namespace
}  // namespace burnish
