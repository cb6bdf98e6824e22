// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/render/gl/gl_renderer.h>
#include <burnish/testing/gl.h>
#include <burnish/testing/models.h>
#include <burnish/testing/scenes.h>

namespace burnish {
namespace {

class GlRendererTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { context_ = std::make_unique<TestContext>(); }
  static void TearDownTestSuite() { context_.reset(); }
  void SetUp() override {
    if (!context_->context) GTEST_SKIP() << context_->reason;
  }
  // The largest distance, in pixels, of a drawn vertex from its place. GPUs have eight bits for the position within a
  // pixel. Mesa's renderers interpolate from the places themselves.
  static double vertex_error() { return context_->context->in_software() ? 0 : 0x1p-8; }

 private:
  static inline std::unique_ptr<TestContext> context_;
};

constexpr int kSize = 160;

Image draw(const Scene& scene, std::span<const SurfaceShader> materials) {
  const GlRenderer renderer(scene, materials, kSize, kSize);
  renderer.draw();
  return renderer.read();
}

const FactoredBrdf& disks() {
  static const FactoredBrdf brdf = smooth_model(model_case("DiskPqp"));
  return brdf;
}
const FactoredBrdf& lines() {
  static const FactoredBrdf brdf = smooth_model(model_case("ManyTables"));
  return brdf;
}
std::vector<SurfaceShader> shaders(ShaderFilter filter, TableFormat precision) {
  return {surface_shader(disks(), filter, precision), surface_shader(lines(), filter, precision)};
}

struct Agreement {
  double worst = 0;  // relative to the pixel, over pixels away from outlines
  double psnr = 0;   // of all pixels, tone mapped
};
// With vertices so many pixels off, a pixel may be off by that share of what its neighbours differ.
Agreement agreement(const Scene& scene, const Image& found, const Image& truth, double vertex_error) {
  Agreement result;
  const auto interior = interior_pixels(scene, kSize, kSize);
  EXPECT_GT(std::ranges::count(interior, 1), 3000);
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    if (!interior[i / 3]) continue;
    const float* const at = &truth.pixels[i];
    double moved = 0;
    for (const std::ptrdiff_t step : {3, 3 * kSize})
      moved +=
          vertex_error * static_cast<double>(std::max(std::abs(at[step] - *at), std::abs(at[-step] - *at)));
    const double off = static_cast<double>(std::abs(found.pixels[i] - *at)) - moved;
    result.worst = std::max(result.worst, off / static_cast<double>(*at + 1e-2f));
  }
  const double exposure = 1 / percentile(truth.pixels, 0.97);
  result.psnr = psnr(mean_squared_error(tone_map(found, exposure), tone_map(truth, exposure)));
  return result;
}

// Directions come from interpolated floats, about 1e-5 off; outlines may move by a pixel here and there.
TEST_F(GlRendererTest, AgreesWithTheReferenceRenderer) {
  const Scene scene = knot_and_sphere();
  const Image truth =
      render_cpu(scene, std::array{BrdfRef(disks()), BrdfRef(lines())}, {.width = kSize, .height = kSize});
  const Agreement exact =
      agreement(scene, draw(scene, shaders(ShaderFilter::exact, TableFormat::single)), truth, vertex_error());
  EXPECT_LT(exact.worst, 1e-4);
  EXPECT_GT(exact.psnr, 50);
  const Agreement half = agreement(scene, draw(scene, shaders(ShaderFilter::hardware, TableFormat::half)),
                                   truth, vertex_error());
  EXPECT_LT(half.worst, 7e-3);
  EXPECT_GT(half.psnr, 50);
}

TEST_F(GlRendererTest, DrawsVolumesAsTheReferenceRenderer) {
  const Scene scene = knot_and_sphere();
  const FactoredBrdf volume = smooth_model(model_case("Volume")),
                     volumes = smooth_model(model_case("Volumes"));
  const Image truth =
      render_cpu(scene, std::array{BrdfRef(volume), BrdfRef(volumes)}, {.width = kSize, .height = kSize});
  const auto drawn = [&](ShaderFilter filter, TableFormat precision) {
    return agreement(scene,
                     draw(scene, std::array{surface_shader(volume, filter, precision),
                                            surface_shader(volumes, filter, precision)}),
                     truth, vertex_error());
  };
  const Agreement exact = drawn(ShaderFilter::exact, TableFormat::single),
                  half = drawn(ShaderFilter::hardware, TableFormat::half);
  EXPECT_LT(exact.worst, 1e-3);  // phi_d near the normal
  EXPECT_GT(exact.psnr, 50);
  EXPECT_LT(half.worst, 1e-2);
  EXPECT_GT(half.psnr, 50);
}

TEST_F(GlRendererTest, InterpolatesWhatVerticesSend) {
  Scene scene = knot_and_sphere();
  std::vector<std::vector<Rgb>> values;
  for (const MeshPart& part : scene.parts)
    for (auto& list = values.emplace_back(); const Vertex& v : part.mesh.vertices)
      list.emplace_back(v.position[0], v.position[1], v.position[2]);
  const GlRenderer renderer(scene, values, kSize, kSize);
  renderer.draw();
  const Image places = renderer.read();
  // what is linear is interpolated exactly: the pixel's ray passes through the place
  const auto interior = interior_pixels(scene, kSize, kSize);
  const CameraFrame frame = frame_of(scene.camera);
  const double step = 2 * std::tan(0.5 * scene.camera.field_of_view) / kSize;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (!interior[static_cast<std::size_t>(y * kSize + x)]) continue;
      const auto p = places.at(x, y);
      const Vec3 w = Vec3{p[0], p[1], p[2]} - scene.camera.eye;
      const double depth = -dot(w, frame.back);
      EXPECT_NEAR(dot(w, frame.right) / depth / step, x + 0.5 - 0.5 * kSize, 0.01);
      EXPECT_NEAR(dot(w, frame.up) / depth / step, 0.5 * kSize - y - 0.5, 0.01);
    }
}

TEST_F(GlRendererTest, AddsAsManyLightsAsThereAre) {
  Scene scene = knot_and_sphere();
  const auto materials = shaders(ShaderFilter::exact, TableFormat::single);
  scene.background = 0;
  const PointLight light = scene.lights[0];
  scene.lights = {light};
  const Image one = draw(scene, materials);
  const int count = GlRenderer::kLightsAPass + 3;
  scene.lights.assign(static_cast<std::size_t>(count), light);
  const Image many = draw(scene, materials);
  for (std::size_t i = 0; i < one.pixels.size(); ++i)
    EXPECT_NEAR(many.pixels[i], static_cast<float>(count) * one.pixels[i], 1e-4f * many.pixels[i] + 1e-9f);
  scene.lights.clear();
  const Image none = draw(scene, materials);
  EXPECT_EQ(*std::ranges::max_element(none.pixels), 0);
}

// Pixels go from one light above their surface to the next, each to its own.
TEST_F(GlRendererTest, SkipsOnlyLightsBelowTheSurface) {
  Scene scene = knot_and_sphere();
  const auto materials = shaders(ShaderFilter::exact, TableFormat::single);
  scene.background = 0;
  const PointLight light = scene.lights[0], opposite{-1.0 * light.position, light.intensity};
  scene.lights = {light};
  const Image front = draw(scene, materials);
  scene.lights = {opposite};
  const Image back = draw(scene, materials);
  scene.lights = {opposite, light, light, opposite, light};
  const Image all = draw(scene, materials);
  int of_front = 0, of_back = 0;  // numbers that one of them alone makes
  for (std::size_t i = 0; i < all.pixels.size(); ++i) {
    const float sum = 3 * front.pixels[i] + 2 * back.pixels[i];
    EXPECT_NEAR(all.pixels[i], sum, 1e-5f * sum);
    of_front += front.pixels[i] > 0 && back.pixels[i] == 0;
    of_back += back.pixels[i] > 0 && front.pixels[i] == 0;
  }
  EXPECT_GT(of_front, 100);
  EXPECT_GT(of_back, 100);
}

TEST_F(GlRendererTest, ShowsTheBackgroundWhereNothingIs) {
  Scene scene;
  scene.background = {0.25, 0.5, 2};
  const Image image = draw(scene, {});
  EXPECT_EQ(image.at(7, 9)[0], 0.25f);
  EXPECT_EQ(image.at(7, 9)[2], 2.0f);
}

TEST_F(GlRendererTest, RefusesShadersTheDriverDoesNotTake) {
  const Scene scene = knot_and_sphere();
  const SurfaceShader broken{
      .declarations = "", .view = "", .light = "", .value = "no_such_name", .textures = {}};
  EXPECT_THROW(draw(scene, std::vector(2, broken)), Error);
  EXPECT_THROW(draw(scene, std::vector(1, broken)), Error) << "a material is missing";
}

}  // namespace
}  // namespace burnish
