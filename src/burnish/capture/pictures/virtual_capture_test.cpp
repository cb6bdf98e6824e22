// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/capture/pictures/virtual_capture.h>
#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/testing/captures.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;

TEST(VirtualCapture, IsWhatTheMaterialsReflect) {
  const TemporaryFolder folder("virtual");
  const SurfaceScene scene = small_scene(8, 3, R"("shadows":false)");
  const CaptureForm form = write_virtual_capture(scene, folder.path);
  const Capture capture(folder.path);
  EXPECT_EQ(capture.form(), form);
  ASSERT_EQ(form.pictures.size(), 6u);
  const CaptureRows rows = capture.read(0, 8).rows;
  for (std::size_t p = 0; p < 6; ++p)
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(3, 6), std::pair(7, 2)}) {
      const auto expected = scene_radiance(scene, x, y, form.pictures[p].light.at, form.pictures[p].view.at);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto at = (p * 64 + static_cast<std::size_t>(8 * y + x)) * 3 + c;
        EXPECT_NEAR(static_cast<double>(rows.values[at]), expected[c], 0x1p-10 * expected[c] + 1e-6);
      }
    }
}

TEST(VirtualCapture, SharesAddUpAndNormalsFollowTheHeights) {
  const SurfaceScene scene = small_scene(16, 3);
  for (std::size_t i = 0; i < 256; ++i) EXPECT_NEAR(scene.shares[0][i] + scene.shares[1][i], 1, 1e-6);
  for (const auto& [x, y] : {std::pair(3, 4), std::pair(9, 9)}) {
    const Vec3 n = scene_normal(scene, x, y);
    const auto height = [&](int i, int j) {
      return static_cast<double>(scene.heights[static_cast<std::size_t>(16 * j + i)]);
    };
    EXPECT_NEAR(-n.x / n.z, (height(x + 1, y) - height(x - 1, y)) * 8, 1e-9);
    EXPECT_NEAR(-n.y / n.z, (height(x, y - 1) - height(x, y + 1)) * 8, 1e-9);
  }
}

// A wall stands across the surface. The texels behind it, under a low light, are dark and masked.
TEST(VirtualCapture, CastsShadows) {
  SurfaceScene scene = small_scene(32, 1);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      scene.heights[static_cast<std::size_t>(32 * y + x)] = x == 16 || x == 17 ? 0.3f : 0.0f;
  scene.lights = {{.at = spherical_direction(1.2, 0)}};  // from +x
  scene.views = {{}};
  scene.held_out = 1;
  const TemporaryFolder folder("shadow");
  const CaptureForm form = write_virtual_capture(scene, folder.path);
  ASSERT_EQ(form.pictures.size(), 1u);
  EXPECT_FALSE(form.pictures.front().mask.empty());
  EXPECT_TRUE(fs::exists(folder.path / form.pictures.front().mask));
  scene.held_out = 0;
  scene.lights.resize(4, scene.lights.front());
  const TemporaryFolder second("shadow_read");
  write_virtual_capture(scene, second.path);
  const CaptureRows rows = Capture(second.path).read(10, 1).rows;
  EXPECT_EQ(rows.values[3 * 13], 0);  // 0.3 / tan(90 - 69 degrees) reaches 25 texels
  EXPECT_GT(rows.values[3 * 24], 0);
}

TEST(VirtualCapture, NoiseAndClippingAreAsAsked) {
  const TemporaryFolder plain("plain"), noisy("noisy");
  small_capture(plain.path, 16, 3);
  small_capture(noisy.path, 16, 3, R"("noise":0.05,"clip":0.15)");
  const CaptureRows a = Capture(plain.path).read(0, 16).rows, b = Capture(noisy.path).read(0, 16).rows;
  double sum = 0, squares = 0;
  std::size_t count = 0, clipped = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    EXPECT_LE(b.values[i], 0.1501f);
    clipped += is_clipped(b.states[i / 3], i % 3);
    if (a.values[i] < 1e-3f || a.values[i] > 0.12f) continue;
    const double off = std::log(static_cast<double>(b.values[i] / a.values[i]));
    sum += off;
    squares += off * off;
    ++count;
  }
  EXPECT_GT(clipped, 0u);
  ASSERT_GT(count, 500u);
  EXPECT_NEAR(sum / static_cast<double>(count), 0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count)), 0.05, 0.005);
}

TEST(VirtualCapture, IsTheSameForAnyThreads) {
  const TemporaryFolder all("all"), one("one");
  small_capture(all.path, 12, 3, R"("noise":0.05,"held_out":3,"misregistered":0.5)");
  {
    const ThreadLimit limit(1);
    small_capture(one.path, 12, 3, R"("noise":0.05,"held_out":3,"misregistered":0.5)");
  }
  for (const auto& entry : fs::directory_iterator(all.path))
    EXPECT_EQ(read(entry.path()), read(one.path / entry.path().filename())) << entry.path();
}

TEST(SurfaceScene, RefusesWhatCannotBe) {
  for (const char* more :
       {R"("noise":-1)", R"("heights":{"cells":0,"amplitude":1})", R"("lights":[])", R"("views":{"count":0})",
        R"("materials":["nowhere.bsdf"])", R"("shares":["a.png"])"})
    EXPECT_THROW(small_scene(4, 1, more), Error) << more;
}

TEST(SurfaceScene, NamesMembersThatItDoesNotKnow) {
  const auto said = [](const char* more) { return error_of([&] { small_scene(4, 1, more); }); };
  EXPECT_THAT(said(R"("noize":0.1)"), testing::HasSubstr("found 'noize'; did you mean 'noise'?"));
  EXPECT_THAT(said(R"("heights":{"cells":2,"amplitude":1,"sede":2})"),
              testing::HasSubstr("heights: expected one of file, cells, seed, amplitude, found 'sede'"));
  EXPECT_THAT(said(R"("shares":{"cells":2,"sharp":2})"), testing::HasSubstr("shares: expected one of"));
  EXPECT_THAT(said(R"("lights":{"count":2,"angle":2})"), testing::HasSubstr("lights: expected one of"));
  EXPECT_NO_THROW(small_scene(4, 1, R"("_why":"a note")"));
}

}  // namespace
}  // namespace burnish
