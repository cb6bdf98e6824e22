// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/render/light/image_based_light.h>
#include <burnish/testing/environments.h>
#include <burnish/testing/gl.h>
#include <burnish/testing/models.h>
#include <burnish/testing/sampling.h>

namespace burnish {
namespace {

constexpr PrefilterOptions kSmall{.slices = 8, .side = 16, .harmonics = 4};

// A coloured glossy lobe over a matt one; factors of the view, of both directions and of the half vector.
FactoredBrdf glossy() {
  const ModelCase form{
      "m", "p(wo) q(h) p(wi) r(theta_d) + s(h)", {"p=8", "q=64,rational:0.2", "r=8", "s=4"}, 3};
  Pcg32 random(5);
  return model_of(form, TableFormat::half, random,
                  [](std::size_t table, const TableLayout& l, int x, int, int c) {
                    const double u = static_cast<double>(x) / l.width;
                    if (table == 1) return -2 * std::log1p(300 * u * u * u);
                    return table == 0 ? -u : table == 2 ? 1.5 * u * u + 0.2 * c : -0.1 * c;
                  });
}

std::vector<std::pair<Vec3, Vec3>> normals_and_views(int count) {
  Pcg32 random(9);
  const auto direction = [&] {
    const double y = 2 * random.uniform() - 1, phi = kTwoPi * random.uniform(), s = std::sqrt(1 - y * y);
    return Vec3{s * std::cos(phi), y, s * std::sin(phi)};
  };
  std::vector<std::pair<Vec3, Vec3>> pairs{{{0, 1, 0}, {0, 1, 0}},  {{0, -1, 0}, {0, -1, 0}},
                                           {{1, 0, 0}, {1, 0, 0}},  {{0, -1, 0}, normalize({1, -1e-3, 0})},
                                           {{0, 0, 1}, {0, 0, -1}}, {{0, 0, 1}, normalize({1e-7, 0, 1})}};
  while (static_cast<int>(pairs.size()) < count) pairs.emplace_back(direction(), direction());
  return pairs;
}

TEST(ImageBasedLight, AnEvenSkyOnAMattSurfaceGivesPiTimesItsValue) {
  const FactoredBrdf matt(1, {}, {Lobe{.scale = {0.25}, .factors = {}}});
  const ImageBasedLight light = prefilter(matt, kEven, {.slices = 2, .side = 8, .harmonics = 0});
  for (const auto& [n, v] : normals_and_views(50))
    EXPECT_NEAR(light.radiance(n, v).g, dot(n, v) > 0 ? kPi * 0.25 * 2 : 0, 2e-3);
}

constexpr int kSize = 24;

Image truth_of(const FactoredBrdf& brdf) {
  return moments_in_environment(brdf, CosineSampler{}, {}, kLamps, {.size = kSize, .samples = 1024}).mean;
}

// Returns the agreement of the lit sphere with `truth`, in decibels.
double agreement(const FactoredBrdf& brdf, int harmonics, const Image& truth) {
  const LitSphere sphere{truth, {}};
  const double exposure = sphere_exposure({&sphere, 1});
  PrefilterOptions options = kSmall;
  options.harmonics = harmonics;
  const ImageBasedLight light = prefilter(brdf, kLamps, options);
  Image found(kSize, kSize, 3);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (const auto n = sphere_normal(kSize, x + 0.5, y + 0.5)) {
        const Rgb value = light.radiance(*n, {0, 0, 1});
        const auto pixel = found.at(x, y);
        pixel[0] = static_cast<float>(value.r);
        pixel[1] = static_cast<float>(value.g);
        pixel[2] = static_cast<float>(value.b);
      }
  return psnr(mean_squared_error(tone_map(found, exposure), tone_map(truth, exposure)));
}

TEST(ImageBasedLight, IsCloseToMonteCarloAndCloserWithEveryOrder) {
  const FactoredBrdf brdf = glossy();
  const Image truth = truth_of(brdf);
  double last = 0;
  for (const int harmonics : {0, 2, 4}) {
    const double decibels = agreement(brdf, harmonics, truth);
    EXPECT_GT(decibels, last) << harmonics;
    last = decibels;
  }
  EXPECT_GE(last, 38);
}

TEST(ImageBasedLight, KeepsTheSideThatAMaterialTurnsTo) {
  const auto twisted = [](double slope) {
    const ModelCase form{"m", "p(wo) q(h) p(wi) w(theta_t)", {"p=8", "q=64,rational:0.2", "w=5"}, 3};
    Pcg32 random(5);
    return model_of(
        form, TableFormat::half, random, [=](std::size_t table, const TableLayout& l, int x, int, int) {
          const double u = static_cast<double>(x) / (l.width - 1);
          return table == 1 ? -2 * std::log1p(100 * u * u * u) : table == 2 ? slope * (u - 0.5) : -u;
        });
  };
  const Image truth = truth_of(twisted(2.5));
  const double kept = agreement(twisted(2.5), 4, truth), mirrored = agreement(twisted(-2.5), 4, truth);
  EXPECT_GE(kept, 36);
  EXPECT_LT(mirrored, kept - 3);
}

TEST(ImageBasedLight, TurnsWithTheWorld) {
  const FactoredBrdf brdf = glossy();
  const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](Vec3 w) { return Vec3{c * w.x + s * w.z, w.y, c * w.z - s * w.x}; };
  const ImageBasedLight still = prefilter(brdf, kLamps, kSmall);
  const ImageBasedLight moved = prefilter(brdf, turned(kLamps, angle), kSmall);
  for (const auto& [n, v] : normals_and_views(300)) {
    const double expected = still.radiance(n, v).r;
    EXPECT_NEAR(moved.radiance(turn(n), turn(v)).r, expected, 0.05 * expected + 0.02);
  }
}

TEST(ImageBasedLight, HasNoSeamBetweenItsHemispheres) {
  const ImageBasedLight light = prefilter(glossy(), kLamps, {.slices = 2, .side = 32, .harmonics = 4});
  for (int i = 0; i < 64; ++i) {
    const double phi = kTwoPi * i / 64, tilt = 1e-9;
    const Vec3 n{std::cos(phi), 0, std::sin(phi)}, v = normalize(n + Vec3{-0.5 * n.z, 0, 0.5 * n.x});
    const double above = light.radiance(normalize({n.x, tilt, n.z}), v).g;
    EXPECT_NEAR(light.radiance(normalize({n.x, -tilt, n.z}), v).g, above, 0.02 * above);
  }
}

// The maps of all lobes and the tables of all factors of the view.
TEST(ImageBasedLight, ReadsTwoTexturesAtMost) {
  const ModelCase volume{"m",
                         "z(theta_h) p(wo) p(wi) r(theta_d) g(theta_h,theta_d,phi_d)",
                         {"z=24,power:0.5", "p=8", "r=6", "g=9x5x4,power:0.5"},
                         3};
  for (const FactoredBrdf& brdf : {glossy(), smooth_model(volume)}) {
    const ImageBasedLight light = prefilter(brdf, kLamps, kSmall);
    EXPECT_LE(1 + generate_shader(light, ShaderLanguage::glsl, "m").tables.size(), 2u)
        << model_expression(brdf);
  }
}

TEST(ImageBasedLight, RefusesWhatItCannotTabulate) {
  const FactoredBrdf brushed = smooth_model(model_case("DiskPqp")), plain = smooth_model(model_case("Pqp"));
  EXPECT_THROW(prefilter(brushed, kEven), Error);
  EXPECT_THROW(prefilter(plain, kEven, {.slices = 1}), Error);
  EXPECT_THROW(prefilter(plain, kEven, {.side = 7}), Error);
  EXPECT_THROW(prefilter(plain, kEven, {.harmonics = 5}), Error);
  const ImageBasedLight light = prefilter(plain, kEven, {.slices = 2, .side = 8, .harmonics = 0});
  EXPECT_EQ(light.fetches(), 2);
  EXPECT_EQ(light.bytes(), 2u * 8 * 16 * 8);
  EXPECT_THROW(generate_shader(light, ShaderLanguage::wgsl, "m"), Error);
}

TEST(ImageBasedLight, TheShaderAgreesWithTheDefinition) {
  const TestContext gl;
  if (!gl.context) GTEST_SKIP() << gl.reason;
  const ImageBasedLight light = prefilter(glossy(), kLamps, kSmall);
  const auto pairs = normals_and_views(2000);
  std::vector<GlVectors> vectors;
  const auto single = [](double x) { return static_cast<float>(x); };
  for (const auto& [n, v] : pairs)
    vectors.push_back({{single(n.x), single(n.y), single(n.z)}, {single(v.x), single(v.y), single(v.z)}});
  const std::vector<float> found = GlImageBasedLight(light).radiance(vectors);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Rgb expected = light.radiance(pairs[i].first, pairs[i].second);
    EXPECT_NEAR(found[3 * i], expected.r, 5e-3 * expected.r + 1e-3) << i;
    EXPECT_NEAR(found[3 * i + 2], expected.b, 5e-3 * expected.b + 1e-3) << i;
  }
}

}  // namespace
}  // namespace burnish
