// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/models.h>
#include <burnish/testing/scenes.h>

namespace burnish {
namespace {

const fixtures::Lambert kMatte;
const fixtures::Glossy kGlossy{.a = 90, .b = 12};

Scene lone_sphere() {
  Scene scene;
  scene.parts = {{make_sphere(64, 32), 0}};
  scene.lights = {{{0, 0, 5}, {32, 16, 8}}};
  scene.camera = camera_for_unit_sphere(0, 0);
  return scene;
}

// [HomomorphicBrdf, eq. 2] by hand: at the sphere's nearest point everything is along the normal
TEST(CpuRenderer, GivesTheRadianceOfAPointLight) {
  const Image image = render_cpu(lone_sphere(), std::array{BrdfRef(kMatte)}, {.width = 65, .height = 65});
  const auto middle = image.at(32, 32);
  EXPECT_NEAR(middle[0], 0.8 / kPi * 32 / 16, 1e-3);
  EXPECT_NEAR(middle[1], 0.5 / kPi * 16 / 16, 1e-3);
  EXPECT_NEAR(middle[2], 0.2 / kPi * 8 / 16, 1e-3);
  EXPECT_EQ(image.at(0, 0)[0], 0);
}

TEST(CpuRenderer, HasTheUnitSphereInItsFrame) {
  constexpr int kSide = 200;
  Scene scene = lone_sphere();
  scene.background = {0, 0, 7};
  for (Vertex& v : scene.parts[0].mesh.vertices)
    v.position = to_floats(1e3 * to_vec3(v.position) + Vec3{5, 6, 7});
  fit_to_unit_sphere(scene.parts);
  const Image image = render_cpu(scene, std::array{BrdfRef(kMatte)}, {.width = kSide, .height = kSide});
  int covered = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const bool sphere = image.at(x, y)[2] != 7;
      covered += sphere;
      EXPECT_FALSE(sphere && (x == 0 || y == 0 || x == kSide - 1 || y == kSide - 1));
    }
  EXPECT_GT(covered, 0.85 * kPi / 4 * kSide * kSide);
}

TEST(CpuRenderer, AddsLights) {
  Scene scene = knot_and_sphere();
  const std::array materials{BrdfRef(kGlossy), BrdfRef(kMatte)};
  scene.background = 0;
  const CpuOptions options{.width = 40, .height = 40};
  const Image all = render_cpu(scene, materials, options);
  Image sum(40, 40, 3);
  for (const PointLight& light : std::vector(scene.lights)) {
    scene.lights = {light};
    const Image one = render_cpu(scene, materials, options);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += one.pixels[i];
  }
  for (std::size_t i = 0; i < sum.pixels.size(); ++i)
    EXPECT_NEAR(sum.pixels[i], all.pixels[i], 1e-6 * (1 + all.pixels[i]));
}

TEST(CpuRenderer, GivesTheSameBitsForEveryNumberOfThreads) {
  const Scene scene = knot_and_sphere();
  const std::array materials{BrdfRef(kGlossy), BrdfRef(kMatte)};
  const CpuOptions options{.width = 70, .height = 50, .shadows = true};
  const Image all = render_cpu(scene, materials, options);
  const ThreadLimit one(1);
  EXPECT_EQ(render_cpu(scene, materials, options), all);
}

TEST(CpuRenderer, ShadowsOnlyTakeLightAway) {
  const Scene scene = knot_and_sphere();
  const std::array materials{BrdfRef(kGlossy), BrdfRef(kMatte)};
  const Image lit = render_cpu(scene, materials, {.width = 60, .height = 60});
  const Image shadowed = render_cpu(scene, materials, {.width = 60, .height = 60, .shadows = true});
  int darker = 0;
  for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
    EXPECT_LE(shadowed.pixels[i], lit.pixels[i]);
    darker += shadowed.pixels[i] < lit.pixels[i];
  }
  EXPECT_GT(darker, 100);
  Scene alone = lone_sphere();
  alone.lights[0].position = {0, 0, -5};  // behind it: nothing but the wrong side
  const Image dark = render_cpu(alone, std::array{BrdfRef(kMatte)}, {.width = 32, .height = 32});
  EXPECT_EQ(*std::ranges::max_element(dark.pixels), 0);
}

TEST(CpuRenderer, ShadesVerticesAsPixels) {
  const Scene scene = lone_sphere();
  const std::array materials{BrdfRef(kGlossy)};
  const auto values = shade_vertices(scene, materials);
  ASSERT_EQ(values.size(), 1u);
  ASSERT_EQ(values[0].size(), scene.parts[0].mesh.vertices.size());
  const Image image = render_cpu(scene, materials, {.width = 65, .height = 65});
  // column 0, row 16 is (0, 0, 1), the nearest point
  EXPECT_NEAR(values[0][16 * 65].r, image.at(32, 32)[0], 1e-4);
}

TEST(CpuRenderer, TurnsTheFrameWhereTextureIsMirrored) {
  Scene scene = lone_sphere();
  scene.lights = {{{3, 2, 4}, 10}};
  // reflects more towards +y of its frame than towards -y
  struct OneSided {
    static std::size_t channels() noexcept { return 1; }
    static bool isotropic() noexcept { return false; }
    static bool eval(Vec3 wi, Vec3 wo, std::span<double> f) noexcept {
      f[0] = wi.z > 0 && wo.z > 0 ? 2 + wi.y : 0;
      return true;
    }
  } const brdf;
  struct Flipped {
    static std::size_t channels() noexcept { return 1; }
    static bool isotropic() noexcept { return false; }
    static bool eval(Vec3 wi, Vec3 wo, std::span<double> f) noexcept {
      f[0] = wi.z > 0 && wo.z > 0 ? 2 - wi.y : 0;
      return true;
    }
  } const flipped;
  const CpuOptions options{.width = 32, .height = 32};
  const Image straight = render_cpu(scene, std::array{BrdfRef(brdf)}, options);
  for (Vertex& v : scene.parts[0].mesh.vertices) v.side = -1;
  const Image mirrored = render_cpu(scene, std::array{BrdfRef(flipped)}, options);
  EXPECT_EQ(straight, mirrored);
  EXPECT_NE(straight, render_cpu(scene, std::array{BrdfRef(brdf)}, options));
}

TEST(Scene, RefusesWhatDoesNotFit) {
  const std::array materials{BrdfRef(kMatte)};
  Scene scene = lone_sphere();
  EXPECT_THROW(render_cpu(scene, materials, {.width = 0, .height = 8}), Error);
  scene.parts[0].material = 1;
  EXPECT_THROW(render_cpu(scene, materials, {.width = 8, .height = 8}), Error);
  scene = lone_sphere();
  scene.parts[0].mesh.triangles[0][0] = 1u << 30;
  EXPECT_THROW(render_cpu(scene, materials, {.width = 8, .height = 8}), Error);
  scene = lone_sphere();
  scene.camera.eye = scene.camera.target;
  EXPECT_THROW(render_cpu(scene, materials, {.width = 8, .height = 8}), Error);
  const fixtures::Lambert two{.count = 2};
  EXPECT_THROW(render_cpu(lone_sphere(), std::array{BrdfRef(two)}, {.width = 8, .height = 8}), Error);
}

TEST(Scene, AveragesSquares) {
  Image image(4, 2, 1);
  image.pixels = {1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(averaged(image, 2).pixels, (std::vector<float>{3.5f, 5.5f}));
  EXPECT_THROW(averaged(image, 3), Error);
}

}  // namespace
}  // namespace burnish
