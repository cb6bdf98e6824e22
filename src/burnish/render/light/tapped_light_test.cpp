// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/render/gl/gl_evaluator.h>
#include <burnish/render/light/tapped_light.h>
#include <burnish/testing/environments.h>
#include <burnish/testing/gl.h>
#include <burnish/testing/models.h>
#include <burnish/testing/sampling.h>

namespace burnish {
namespace {

constexpr BlurOptions kSmallBlur{.side = 32, .levels = 8, .narrowest = 0.04, .step = 1.5};

// A highlight three times as long across the tangent as along it.
FactoredBrdf brushed() {
  const ModelCase form{"m", "p(wo) q(h) p(wi)", {"p=8", "q=64x64,rational:0.2"}, 3};
  Pcg32 random(5);
  return model_of(form, TableFormat::half, random,
                  [](std::size_t table, const TableLayout& l, int x, int y, int c) {
                    if (table == 0) return -static_cast<double>(x) / l.width;
                    const Vec3 h = node_direction(l, x, y);
                    const double u = h.x / std::max(h.z, 0.1) / 0.15, v = h.y / std::max(h.z, 0.1) / 0.45;
                    return -2 * std::log1p(u * u + v * v) - 0.1 * c;
                  });
}

// The same with a volume and a line, which grows with theta_h.
FactoredBrdf brushed_volume() {
  const ModelCase form{
      "m", "q(h) z(theta_h) g(theta_d,theta_h,phi_d)", {"q=64x64,rational:0.2", "z=8", "g=24x18x6"}, 3};
  Pcg32 random(5);
  return model_of(form, TableFormat::half, random,
                  [&](std::size_t table, const TableLayout& l, int x, int y, int c) {
                    if (table == 1) return 0.5 * x / l.width;
                    if (table == 2) return 0.3 * std::sin(0.4 * x + 0.7 * y + c);
                    const Vec3 h = node_direction(l, x, y);
                    const double u = h.x / std::max(h.z, 0.1) / 0.15, v = h.y / std::max(h.z, 0.1) / 0.45;
                    return -2 * std::log1p(u * u + v * v) - 0.1 * c;
                  });
}

TEST(TappedLight, AnEvenSkyOnAMattSurfaceGivesPiTimesItsValue) {
  const FactoredBrdf matt(1, {}, {Lobe{.scale = {0.25}, .factors = {}}});
  const TappedBrdf tapped = tap(matt, 48);
  const BlurredEnvironment even = blur(kEven, kSmallBlur);
  for (const Vec3 v : {Vec3{0, 0, 1}, normalize({0.5, 0.1, 0.2}), normalize({1, 1, 0.01})})
    EXPECT_NEAR(tapped.radiance(even, sphere_frame({0, 0, 1}), v).g, kPi * 0.25 * 2, 0.03);
  EXPECT_EQ(tapped.radiance(even, sphere_frame({0, 0, 1}), {0, 0, -1}), Rgb());
}

TEST(TappedLight, IsCloseToMonteCarloOnBrushedMetalAndCloserWithMoreTaps) {
  const FactoredBrdf brdf = brushed();
  ASSERT_FALSE(brdf.isotropic());
  constexpr int kPictureSize = 14;
  const Image truth =
      moments_in_environment(brdf, CosineSampler{}, {}, kLamps, {.size = kPictureSize, .samples = 900}).mean;
  const LitSphere sphere{truth, {}};
  const double exposure = sphere_exposure({&sphere, 1});
  const BlurredEnvironment blurred = blur(kLamps);
  double last = 0;
  for (const int taps : {12, 96}) {
    const TappedBrdf tapped = tap(brdf, taps);
    Image found(kPictureSize, kPictureSize, 3);
    for (int y = 0; y < kPictureSize; ++y)
      for (int x = 0; x < kPictureSize; ++x)
        if (const auto n = sphere_normal(kPictureSize, x + 0.5, y + 0.5)) {
          const Rgb value = tapped.radiance(blurred, sphere_frame(*n), {0, 0, 1});
          const auto pixel = found.at(x, y);
          pixel[0] = static_cast<float>(value.r);
          pixel[1] = static_cast<float>(value.g);
          pixel[2] = static_cast<float>(value.b);
        }
    const double decibels = psnr(mean_squared_error(tone_map(found, exposure), tone_map(truth, exposure)));
    EXPECT_GT(decibels, last + 3) << taps;
    last = decibels;
  }
  EXPECT_GE(last, 36);
}

void expect_agreement(const FactoredBrdf& brdf, const BlurOptions& options, std::size_t textures) {
  const TestContext gl;
  if (!gl.context) GTEST_SKIP() << gl.reason;
  const TappedBrdf tapped = tap(brdf, 24);
  const BlurredEnvironment blurred = blur(kLamps, options);
  const TappedShader shader = generate_shader(tapped, blurred, ShaderLanguage::glsl, "m");
  GlFunction function(shader.text +
                          "vec3 on_sphere(vec3 n, vec3 v) {\n"
                          "  vec3 t = normalize(cross(vec3(0, 1, 0), n));\n"
                          "  return burnish_m_light(n, t, cross(n, t), v);\n}\n",
                      "on_sphere");
  EXPECT_EQ(shader.textures.size(), textures) << "of the environment and all lobes";
  set_textures(function, shader.textures, TableFormat::single, true);
  Pcg32 random(3);
  std::vector<GlVectors> calls;
  std::vector<Rgb> expected;
  const auto direction = [&] {
    const double y = 1.9 * random.uniform() - 0.95, phi = kTwoPi * random.uniform(), s = std::sqrt(1 - y * y);
    return Vec3{s * std::cos(phi), y, s * std::sin(phi)};
  };
  for (int i = 0; i < 500; ++i) {
    const Vec3 n = direction(), v = direction();
    const auto single = [](double x) { return static_cast<float>(x); };
    calls.push_back({{single(n.x), single(n.y), single(n.z)}, {single(v.x), single(v.y), single(v.z)}});
    expected.push_back(tapped.radiance(blurred, sphere_frame(n), v));
  }
  const std::vector<float> found = function.call(calls);
  // a GPU's texture unit has 8 bits for where between two texels it reads, and lamps are steep
  const double share = gl.context->in_software() ? 1e-3 : 1e-2;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    EXPECT_NEAR(found[3 * i], std::max(expected[i].r, 0.0), share * expected[i].r + 1e-3) << i;
    EXPECT_NEAR(found[3 * i + 2], std::max(expected[i].b, 0.0), share * expected[i].b + 1e-3) << i;
  }
  EXPECT_THROW(generate_shader(tapped, blurred, ShaderLanguage::wgsl, "m"), Error);
}

TEST(TappedLight, TheShaderAgreesWithTheDefinition) {
  expect_agreement(brushed(), kSmallBlur, 2);
}

// With a volume that is smaller than the environment's maps and one that is larger.
TEST(TappedLight, VolumesStandBehindTheEnvironment) {
  for (const BlurOptions& options : {kSmallBlur, BlurOptions{.side = 8, .levels = 3}})
    expect_agreement(brushed_volume(), options, 2);
}

TEST(TappedLight, RefusesWhatItCannotTabulate) {
  const FactoredBrdf brdf = smooth_model(model_case("DiskPqp"));
  EXPECT_THROW(tap(brdf, 0), Error);
  EXPECT_THROW(tap(brdf, 257), Error);
  EXPECT_EQ(tap(brdf, 4).fetches(), 1 + 4 * 3);
}

}  // namespace
}  // namespace burnish
