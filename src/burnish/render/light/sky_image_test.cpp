// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/render/light/environment_light.h>
#include <burnish/render/light/sky_image.h>
#include <burnish/render/picture.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

// Random texels, one of them a lamp.
Image picture(int height) {
  Image image(2 * height, height, 3);
  Pcg32 random(4);
  for (float& value : image.pixels) value = static_cast<float>(random.uniform());
  image.at(3, 1)[1] = 200;
  return image;
}

TEST(SkyImage, ShowsItsTexelsAndIsLinearBetweenThem) {
  const SkyImage sky(picture(8));
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x)
      EXPECT_NEAR(sky.radiance(sky.direction(x, y)).g, sky.image().at(x, y)[1], 1e-3);
  EXPECT_NEAR(sky.radiance(sky.direction(5.5, 3)).r,
              0.5 * (sky.image().at(5, 3)[0] + sky.image().at(6, 3)[0]), 1e-6);
  EXPECT_NEAR(sky.radiance(sky.direction(15.5, 3)).r,
              0.5 * (sky.image().at(15, 3)[0] + sky.image().at(0, 3)[0]), 1e-6);
  const Vec3 middle = sky.direction(7.5, 3.5), up = sky.direction(0, -0.5);
  EXPECT_NEAR(dot(middle, {1, 0, 0}), 1, 1e-12);
  EXPECT_NEAR(dot(up, {0, 1, 0}), 1, 1e-12);
}

TEST(SkyImage, TexelsCoverTheSphereOnce) {
  const SkyImage sky(picture(8));
  double total = 0;
  for (int y = 0; y < 8; ++y) total += 16 * sky.solid_angle(y);
  EXPECT_NEAR(total, 4 * kPi, 1e-12);
}

TEST(SkyImage, DrawsInProportionToItsDensity) {
  const SkyImage sky(picture(4));
  constexpr int kSide = 300;
  double inverse = 0, inside = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const DrawnDirection drawn = sky.draw({(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide});
    ASSERT_GT(drawn.pdf, 0);
    EXPECT_NEAR(drawn.pdf, sky.pdf(drawn.wi), 1e-9 * drawn.pdf);
    inverse += 1 / drawn.pdf;  // its mean is the solid angle that is drawn from
    inside += drawn.wi.y > 0;
  }
  EXPECT_NEAR(inverse / (kSide * kSide), 4 * kPi, 0.05 * 4 * kPi);
  EXPECT_GT(inside, 0.5 * kSide * kSide) << "the lamp is above";
  const SkyImage black(Image(4, 2, 3));
  EXPECT_EQ(black.draw({0.5, 0.5}).pdf, 0);
  EXPECT_EQ(black.pdf({0, 1, 0}), 0);
}

TEST(SkyImage, KeepsItsLightWhenItShrinks) {
  const auto light = [](const SkyImage& sky) {
    double sum = 0;
    for (int y = 0; y < sky.image().height; ++y)
      for (int x = 0; x < sky.image().width; ++x) sum += sky.solid_angle(y) * sky.image().at(x, y)[1];
    return sum;
  };
  const Image image = picture(16);
  EXPECT_NEAR(light(SkyImage(smaller_sky(image, 8))), light(SkyImage(image)), 1e-2 * light(SkyImage(image)));
  EXPECT_EQ(smaller_sky(image, 8).width, 8);
  EXPECT_EQ(smaller_sky(image, 64), image);
}

TEST(SkyImage, APictureOfAnEnvironmentLightsAsItDoes) {
  const GgxProxy material{{0.25, 0.25}, 0.6};
  struct Grey {
    static constexpr std::size_t channels() noexcept { return 1; }
    static constexpr bool isotropic() noexcept { return true; }
    bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
      f[0] = wi.z > 0 && wo.z > 0 ? 0.3 : 0;
      return true;
    }
  } const grey;
  const Environment lamp{
      "lamp", {0.3, 0.5, 1}, {1, 1, 1}, {0.2, 0.1, 0.1}, {{normalize({0.4, 0.5, 0.7}), 0.5, 6}}};
  const SkyImage grid(Image(512, 256, 3));
  Image image = grid.image();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb value = lamp.radiance(grid.direction(x, y));
      image.at(x, y)[0] = static_cast<float>(value.r);
      image.at(x, y)[1] = static_cast<float>(value.g);
      image.at(x, y)[2] = static_cast<float>(value.b);
    }
  Environment shown{.name = "picture", .picture = std::make_shared<const SkyImage>(image)};
  const LightOptions options{.size = 5, .samples = 10000};
  const Image expected = moments_in_environment(grey, material, {}, lamp, options).mean;
  const Image found = moments_in_environment(grey, material, {}, shown, options).mean;
  for (std::size_t i = 0; i < found.pixels.size(); ++i)
    EXPECT_NEAR(found.pixels[i], expected.pixels[i], 0.03 * expected.pixels[i] + 1e-3);
}

TEST(SkyImage, ReadsOpenExrAndRefusesWhatIsNone) {
  const Image image = picture(8);
  const std::string bytes = encode_exr(image);
  EXPECT_EQ(parse_sky(memory_file(bytes)).image(), image);
  Image wrong(8, 8, 3), bad = image;
  EXPECT_THROW(parse_sky(memory_file(encode_exr(wrong))), Error);
  bad.pixels[7] = std::nanf("");
  EXPECT_THROW(parse_sky(memory_file(encode_exr(bad))), Error);
  bad.pixels[7] = -1;
  EXPECT_EQ(parse_sky(memory_file(encode_exr(bad))).image().pixels[7], 0);
  for (std::size_t size = 0; size < bytes.size(); size += 37)
    EXPECT_THROW(parse_sky(memory_file(bytes.substr(0, size))), Error) << size;
  EXPECT_THROW(SkyImage(Image(8, 4, 1)), Error);
  // a header that promises 8192 x 4096 pixels
  std::string lying = bytes;
  for (const char* name : {"dataWindow", "displayWindow"}) {
    const std::size_t box =
        lying.find(name) + std::string(name).size() + 1 + 6 + 4;  // type "box2i", its size
    lying.replace(box + 8, 2, "\xff\x1f");
    lying.replace(box + 12, 2, "\xff\x0f");
  }
  EXPECT_THROW(parse_sky(memory_file(lying)), Error);
}

}  // namespace
}  // namespace burnish
