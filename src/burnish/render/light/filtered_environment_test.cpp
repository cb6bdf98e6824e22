// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/render/light/filtered_environment.h>
#include <burnish/testing/environments.h>

namespace burnish {
namespace {

constexpr BlurOptions kFewBlurs{.side = 32, .levels = 8, .narrowest = 0.04, .step = 1.5};

TEST(BlurWeight, IsOneOverTheSphereAndFallsFromItsAxis) {
  for (const double width : {0.02, 0.1, 0.5, 1.0}) {
    // in cosine = 1 - 2 u^4, which is dense at the axis; by Simpson's rule
    constexpr int kSteps = 1000;
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
      const double u = static_cast<double>(i) / kSteps;
      const int simpson = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
      sum += simpson / (3.0 * kSteps) * kTwoPi * 8 * u * u * u * blur_weight(1 - 2 * u * u * u * u, width);
    }
    EXPECT_NEAR(sum, 1, 1e-6) << width;
    // to 1 / e where 1 - cosine is width^2
    EXPECT_NEAR(blur_weight(1 - width * width, width), std::exp(-1) * blur_weight(1, width),
                1e-12 * blur_weight(1, width));
  }
}

TEST(BlurredEnvironment, KeepsAnEvenSkyAndTheLightOfADisc) {
  const BlurredEnvironment even = blur(kEven, kFewBlurs);
  const Environment lamp{"lamp", 0, 0, 0, {{{0, 1, 0}, 0.1, 5}}};
  const BlurredEnvironment one = blur(lamp, kFewBlurs);
  const double light = 5 * kTwoPi * (1 - std::cos(0.1));
  for (const double width : {0.04, 0.2, 0.5}) {
    for (const Vec3 w : {Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{1, 0, 0}, normalize({1, -2, 3})})
      EXPECT_NEAR(even.radiance(w, width).g, 2, 1e-3);
    double sum = 0;  // over the sphere it is still all there
    const SkyImage grid(Image(256, 128, 3));
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 256; ++x) sum += grid.solid_angle(y) * one.radiance(grid.direction(x, y), width).r;
    EXPECT_NEAR(sum, light, (width < 0.1 ? 0.1 : 0.05) * light) << width;  // narrower than 1.3 texels
  }
  EXPECT_THROW(blur(kEven, {.side = 7}), Error);
  EXPECT_THROW(blur(kEven, {.levels = 1}), Error);
  EXPECT_THROW(blur(kEven, {.step = 1}), Error);
}

TEST(BlurredEnvironment, AddsUpWhatItsDiscsGive) {
  const DistantDisc one{normalize({0.3, 0.8, -0.4}), 0.1, 5}, other{normalize({-1, -0.1, 0.2}), 0.3, 2};
  const auto blurred = [](std::vector<DistantDisc> discs) {
    return blur({"discs", 0, 0, 0, std::move(discs)}, {.side = 16, .levels = 4});
  };
  const BlurredEnvironment both = blurred({one, other}), first = blurred({one}), second = blurred({other});
  double most = 0;
  for (std::size_t i = 0; i < both.maps.size(); ++i) {
    const double expected = static_cast<double>(first.maps[i]) + static_cast<double>(second.maps[i]);
    EXPECT_NEAR(both.maps[i], expected, 3 * 0x1p-24 * expected);  // the roundings of three floats
    most = std::max(most, expected);
  }
  EXPECT_GT(most, 1);
}

// Each hemisphere's map is off by what linear interpolation along two axes is, h^2 / 8 times the second derivative.
TEST(BlurredEnvironment, HasNoSeamBetweenItsHemispheres) {
  const BlurOptions options{.side = 96, .levels = 2, .narrowest = 0.3, .step = 2};
  const BlurredEnvironment lamps = blur(kLamps, options);
  const double h = 2.0 / (options.side - 1);
  for (const double phi : {0.1, 1.7, 3.0, 5.5})
    for (const double width : {0.3, 0.6}) {
      const Rgb above = lamps.radiance({std::cos(phi), 1e-9, std::sin(phi)}, width),
                below = lamps.radiance({std::cos(phi), -1e-9, std::sin(phi)}, width);
      EXPECT_NEAR(above.b, below.b, 2 * 2 * h * h / 8 / (width * width) * above.b) << phi << " " << width;
    }
}

TEST(BlurredEnvironment, IsLinearInTheLogarithmOfTheWidthAndEndsAtItsLevels) {
  const BlurredEnvironment lamps = blur(kLamps, kFewBlurs);
  const Vec3 w = normalize({0.4, 0.6, 0.6});
  const auto at = [&](double level) { return lamps.radiance(w, 0.04 * std::pow(1.5, level)).r; };
  EXPECT_GT(at(0), 1.5 * at(7));  // a lamp is there
  for (const double level : {0.0, 3.0, 6.0})
    for (const double share : {0.25, 0.5})
      EXPECT_NEAR(at(level + share), (1 - share) * at(level) + share * at(level + 1), 1e-9 * at(level));
  EXPECT_EQ(lamps.radiance(w, 1e-9).r, at(0));
  EXPECT_NEAR(lamps.radiance(w, 100).r, at(7), 1e-9 * at(7));
}

}  // namespace
}  // namespace burnish
