// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <gtest/gtest.h>

#include <burnish/capture/ranks/sampled_texels.h>
#include <burnish/testing/captures.h>
#include <burnish/testing/crews.h>

namespace burnish {
namespace {

constexpr int kSampledSide = 20;

struct SampledFolder {
  TemporaryFolder folder;
  explicit SampledFolder(const std::string& name) : folder("sampled_texels_" + name) {
    small_capture(folder.path, kSampledSide, 8, R"("held_out":4)");
  }
  SampledTexels sample(std::size_t values, std::size_t tile_bytes, FitCrew* crew = nullptr) const {
    Capture capture(folder.path);
    return sample_texels(capture, values, tile_bytes, 1, nullptr, crew);
  }
};

TEST(SampledTexels, AreThePicturesOneInEachCell) {
  const SampledFolder folder("cells");
  const Capture capture(folder.folder.path);
  const std::size_t pictures = capture.form().pictures.size();
  const CaptureRows rows = capture.read(0, kSampledSide).rows;
  // This many values hold 5 x 5 texels.
  const TexelSamples found = folder.sample(3 * pictures * 25, 1 << 20).samples;
  ASSERT_EQ(found.size(), 25u);
  ASSERT_EQ(found.pictures, pictures);
  std::set<std::pair<int, int>> cells;
  for (std::size_t t = 0; t < found.size(); ++t) {
    const auto [x, y] = found.texels[t];
    cells.insert({x / 4, y / 4});
    for (std::size_t p = 0; p < pictures; ++p) {
      const std::size_t pixel = p * rows.texels() + static_cast<std::size_t>(y * kSampledSide + x);
      EXPECT_EQ(found.states[p * 25 + t], rows.states[pixel]);
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(found.values[3 * (p * 25 + t) + c], rows.values[3 * pixel + c]) << x << " " << y;
    }
  }
  EXPECT_EQ(cells.size(), 25u);
}

TEST(SampledTexels, AreTheSameForAnyTilesAndRanks) {
  const SampledFolder folder("ranks");
  const auto expect_same = [](const SampledTexels& found, const SampledTexels& expected) {
    EXPECT_EQ(found.samples.texels, expected.samples.texels);
    EXPECT_EQ(found.samples.values, expected.samples.values);
    EXPECT_EQ(found.samples.states, expected.samples.states);
    EXPECT_EQ(found.missing, expected.missing);
    EXPECT_EQ(found.clipped, expected.clipped);
  };
  const SampledTexels whole = folder.sample(2000, 1 << 20);
  EXPECT_GT(whole.samples.size(), 10u);
  expect_same(folder.sample(2000, 1), whole);  // a row at a time
  for (const SampledTexels& found :
       at_every_rank(3, [&](FitCrew* crew) { return folder.sample(2000, 5000, crew); }))
    expect_same(found, whole);
}

}  // namespace
}  // namespace burnish
