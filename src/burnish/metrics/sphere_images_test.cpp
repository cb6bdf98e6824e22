// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

using fixtures::Glossy;
using fixtures::Lambert;

void expect_near(Vec3 a, Vec3 b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

Image noise(int width, int height, std::size_t channels, std::uint64_t seed) {
  Image image(width, height, channels);
  Pcg32 random(seed);
  for (float& value : image.pixels) value = static_cast<float>(random.uniform());
  return image;
}

Image constant(int size, float value) {
  Image image(size, size, 1);
  std::ranges::fill(image.pixels, value);
  return image;
}

TEST(SphereGeometry, PixelCentresHaveTheNormalsOfAUnitSphereOfHalfTheFrame) {
  // the pixel right of and above the centre of a 256 frame lies half a pixel off it
  expect_near(*sphere_normal(256, 128.5, 127.5),
              {0.5 / 128, 0.5 / 128, std::sqrt(1 - 2 * 0.25 / (128.0 * 128.0))}, 1e-15);
  expect_near(*sphere_normal(256, 256 - 1e-9, 128), {1, 0, 0}, 1e-4);
  expect_near(*sphere_normal(256, 128, 64), {0, 0.5, std::sqrt(0.75)}, 1e-15);
  EXPECT_FALSE(sphere_normal(256, 0.5, 0.5));
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      if (const auto n = sphere_normal(64, x + 0.5, y + 0.5)) {
        EXPECT_NEAR(length(*n), 1, 1e-15);
        EXPECT_GT(n->z, 0);
      }
}

TEST(SphereGeometry, TangentIsUpCrossNormal) {
  Pcg32 random(3);
  for (int i = 0; i < 200; ++i) {
    const auto n = sphere_normal(2, 2 * random.uniform(), 2 * random.uniform());
    if (!n) continue;
    const Vec3 t = normalize(cross(Vec3{0, 1, 0}, *n));
    expect_near(sphere_local(*n, t), {1, 0, 0}, 1e-12);
    expect_near(sphere_local(*n, cross(*n, t)), {0, 1, 0}, 1e-12);
    expect_near(sphere_local(*n, *n), {0, 0, 1}, 1e-12);
  }
  // facing the viewer, the tangent runs to the right and the bitangent upwards
  expect_near(sphere_local({0, 0, 1}, {1, 0, 0}), {1, 0, 0}, 0);
  expect_near(sphere_local({0, 0, 1}, {0, 1, 0}), {0, 1, 0}, 0);
}

TEST(SphereImage, OfALambertianSurfaceIsItsAlbedoTimesTheCosine) {
  for (const double light : kSphereLights) {
    const LitSphere sphere = render_sphere(Lambert{}, light, 32);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const auto n = sphere_normal(32, x + 0.5, y + 0.5);
        const double cosine = n ? std::max(0.0, n->x * std::sin(light) + n->z * std::cos(light)) : 0;
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(sphere.image.at(x, y)[c], Lambert{}.albedo[c] / kPi * cosine, 1e-7);
      }
  }
}

TEST(SphereImage, LightsComeFromTheRight) {
  const Image image = render_sphere(Lambert{}, radians(60), 32).image;
  EXPECT_GT(image.at(28, 16)[0], 2 * image.at(12, 16)[0]);
  EXPECT_EQ(image.at(2, 16)[0], 0);
}

TEST(SphereImage, StretchesAnAnisotropicHighlightAlongItsBroadDirection) {
  // broad in h.y: the highlight runs up and down
  const Image image = render_sphere(Glossy{.a = 400, .b = 4}, 0, 64).image;
  EXPECT_GT(image.at(32, 16)[0], 3 * image.at(16, 32)[0]);
}

TEST(SphereImage, MarksPixelsTheSourceDoesNotKnow) {
  const LitSphere sphere = render_sphere(Glossy{.blind_below = 0.9}, radians(60), 32);
  // the half angle between light and view is 30 degrees everywhere: cos is 0.866, so all that is lit is
  // unknown
  const LitSphere lit = render_sphere(Lambert{}, radians(60), 32);
  for (std::size_t p = 0; p < sphere.known.size(); ++p)
    EXPECT_EQ(sphere.known[p] == 0, lit.image.pixels[3 * p] > 0) << "pixel " << p;
}

TEST(SphereImage, RefusesSillySizes) {
  EXPECT_THROW(render_sphere(Lambert{}, 0, 0), Error);
  EXPECT_THROW(render_dome(Lambert{}, 100'000), Error);
  EXPECT_THROW(lit_sphere(Lambert{}, {.size = 32, .supersampling = 0}), Error);
}

TEST(Dome, ShowsTheAlbedo) {
  const Image image = render_dome(Lambert{}, 32);
  for (const int x : {3, 8, 16, 28})
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(image.at(x, 16)[c], Lambert{}.albedo[c], 0.005 * Lambert{}.albedo[c]) << "column " << x;
  EXPECT_EQ(image.at(0, 0)[0], 0);
}

TEST(Dome, OfAnAnisotropicSurfaceTurnsWithTheTangent) {
  // exchanging the two widths turns the material by a quarter: rows and columns change places
  const Image a = render_dome(Glossy{.a = 40, .b = 2}, 16), b = render_dome(Glossy{.a = 2, .b = 40}, 16);
  EXPECT_GT(std::abs(a.at(13, 7)[0] - b.at(13, 7)[0]), 0.02f);
  EXPECT_NEAR(a.at(8, 8)[0], b.at(8, 8)[0], 0.02);
}

TEST(Percentile, IsLinearBetweenOrderStatistics) {
  EXPECT_EQ(percentile({5}, 0.97), 5);
  EXPECT_DOUBLE_EQ(percentile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(percentile({4, 1, 3, 2}, 1), 4);
  EXPECT_DOUBLE_EQ(percentile({4, 1, 3, 2}, 0), 1);
  std::vector<float> ramp;
  for (int i = 100; i >= 0; --i) ramp.push_back(static_cast<float>(i));
  EXPECT_NEAR(percentile(ramp, 0.97), 97, 1e-9);
  EXPECT_THROW(percentile({}, 0.5), Error);
}

TEST(Exposure, MakesThe97thPercentileOfTheSpherePixelsWhite) {
  LitSphere sphere{Image(16, 16, 1), std::vector<std::uint8_t>(256, 1)};
  std::vector<float> inside;
  Pcg32 random(5);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      sphere.image.at(x, y)[0] = 1000;  // outside the sphere it must not count
      if (!sphere_normal(16, x + 0.5, y + 0.5)) continue;
      inside.push_back(sphere.image.at(x, y)[0] = static_cast<float>(random.uniform()));
    }
  EXPECT_NEAR(sphere_exposure({&sphere, 1}), 1 / percentile(inside, 0.97), 1e-12);
}

TEST(Exposure, FallsBackToTheBrightestPixelThenToOne) {
  LitSphere sphere{Image(16, 16, 1), std::vector<std::uint8_t>(256, 1)};
  EXPECT_EQ(sphere_exposure({&sphere, 1}), 1);
  sphere.image.at(8, 8)[0] = 0.25f;
  EXPECT_EQ(sphere_exposure({&sphere, 1}), 4);
}

TEST(ToneMap, ExposesClampsAndEncodes) {
  Image image(4, 1, 1);
  image.pixels = {-1, 0, 0.25f, 9};
  EXPECT_EQ(tone_map(image, 2).pixels,
            (std::vector<float>{0, 0, static_cast<float>(std::pow(0.5, 1 / 2.2)), 1}));
}

TEST(Psnr, OfAConstantOffsetIsItsSquareInDecibel) {
  EXPECT_NEAR(mean_squared_error(constant(16, 0.5f), constant(16, 0.6f)), 0.01, 1e-7);
  EXPECT_NEAR(psnr(0.01), 20, 1e-12);
  EXPECT_EQ(psnr(0), std::numeric_limits<double>::infinity());
}

TEST(Ssim, OfConstantImagesIsTheLuminanceTerm) {
  constexpr double kA = 0.5, kB = 0.75, kC1 = 1e-4;
  EXPECT_NEAR(ssim(constant(16, kA), constant(16, kB)), (2 * kA * kB + kC1) / (kA * kA + kB * kB + kC1),
              1e-12);
}

TEST(Ssim, IsTheMeanOfTheFormulaOverTheMirroredFrame) {
  const Image a = noise(9, 7, 1, 1), b = noise(9, 7, 1, 2);
  const auto mirrored = [](int i, int size) { return i < 0 ? -1 - i : i >= size ? 2 * size - 1 - i : i; };
  double sum = 0;
  for (int cy = 0; cy < 7; ++cy)
    for (int cx = 0; cx < 9; ++cx) {
      double weights = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
      for (int dy = -6; dy <= 6; ++dy)
        for (int dx = -6; dx <= 6; ++dx) {
          const double w = std::exp(-(dx * dx + dy * dy) / 4.5);
          const int x = mirrored(cx + dx, 9), y = mirrored(cy + dy, 7);
          const double u = a.at(x, y)[0], v = b.at(x, y)[0];
          weights += w;
          ma += w * u;
          mb += w * v;
          aa += w * u * u;
          bb += w * v * v;
          ab += w * u * v;
        }
      ma /= weights;
      mb /= weights;
      const double va = aa / weights - ma * ma, vb = bb / weights - mb * mb, cov = ab / weights - ma * mb;
      sum += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
    }
  EXPECT_NEAR(ssim(a, b), sum / 63, 1e-12);
}

TEST(Ssim, IsOneForEqualImagesSymmetricAndBelowOneOtherwise) {
  const Image a = noise(20, 17, 3, 1), b = noise(20, 17, 3, 2);
  EXPECT_NEAR(ssim(a, a), 1, 1e-12);
  EXPECT_NEAR(ssim(a, b), ssim(b, a), 1e-12);
  EXPECT_LT(ssim(a, b), 0.5);
}

TEST(Ssim, GreyStandsForEveryChannel) {
  const Image grey = noise(16, 16, 1, 1), colour = noise(16, 16, 3, 2);
  Image broadcast(16, 16, 3);
  for (std::size_t i = 0; i < broadcast.pixels.size(); ++i) broadcast.pixels[i] = grey.pixels[i / 3];
  EXPECT_DOUBLE_EQ(ssim(grey, colour), ssim(broadcast, colour));
  EXPECT_DOUBLE_EQ(mean_squared_error(grey, colour), mean_squared_error(broadcast, colour));
}

TEST(Ssim, RefusesImagesThatDoNotFit) {
  EXPECT_THROW(ssim(noise(16, 16, 1, 1), noise(16, 17, 1, 1)), Error);
  EXPECT_THROW(ssim(noise(16, 16, 2, 1), noise(16, 16, 3, 1)), Error);
  EXPECT_THROW(ssim(noise(5, 16, 1, 1), noise(5, 16, 1, 1)), Error);
}

TEST(LitSpherePicture, IsTransparentAroundAnAntialiasedSphere) {
  const Image8 picture = lit_sphere(Lambert{}, {.size = 64});
  ASSERT_EQ(picture.channels, 4);
  EXPECT_EQ(picture.at(0, 0)[3], 0);
  EXPECT_EQ(picture.at(32, 32)[3], 255);
  double covered = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) covered += picture.at(x, y)[3] / 255.0;
  EXPECT_NEAR(covered / (64 * 64), kPi / 4, 0.002);
  EXPECT_GT(picture.at(40, 32)[0], picture.at(40, 32)[2]);  // the albedo is reddish
}

}  // namespace
}  // namespace burnish
