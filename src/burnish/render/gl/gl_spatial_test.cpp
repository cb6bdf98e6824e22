// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/eval/spatial_eval.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/render/gl/gl_function.h>
#include <burnish/render/gl/gl_renderer.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/shaders/spatial_shader.h>
#include <burnish/testing/gl.h>
#include <burnish/testing/surfaces.h>

namespace burnish {
namespace {

class GlSpatial : public testing::Test {
 protected:
  static void SetUpTestSuite() { context_ = std::make_unique<TestContext>(); }
  static void TearDownTestSuite() { context_.reset(); }
  void SetUp() override {
    if (!context_->context) GTEST_SKIP() << context_->reason;
  }

 private:
  static inline std::unique_ptr<TestContext> context_;
};

struct Question {
  double u, v, lod;
  Vec3 wi, wo;
};

std::vector<Question> questions(const SpatialBrdf& surface, std::size_t count) {
  Pcg32 random(5);
  std::vector<Question> all;
  while (all.size() < count) {
    const auto direction = [&] {
      return normalize({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform()});
    };
    const Question q{3 * random.uniform() - 1, 3 * random.uniform() - 1, 3.5 * random.uniform(), direction(),
                     direction()};
    const ShadingFrame frame = surface.frame(q.u, q.v, q.lod);
    if (std::min(frame.local(q.wi).z, frame.local(q.wo).z) > 0.02) all.push_back(q);
  }
  return all;
}

// The shader's answers, with maps of floats or as they are exported.
std::vector<float> answers(const SpatialBrdf& surface, const std::vector<Question>& questions,
                           ShaderFilter filter, bool single_maps, bool in_blocks = false) {
  const SpatialShader shader =
      generate_shader(surface, {.filter = filter, .name = "wall", .maps_in_blocks = in_blocks});
  GlFunction function(
      shader.text +
          "layout(std430, binding = 2) readonly buffer Places { float places[]; };\n"
          "vec3 call(vec3 wi, vec3 wo) {\n"
          "  uint i = 3u * gl_GlobalInvocationID.x;\n"
          "  return burnish_wall(wi, wo, burnish_wall_at(places[i], places[i + 1u], places[i + 2u]));\n}\n",
      "call");
  for (const ShaderTexture& texture : shader.textures)
    function.set_texture(upload_of(texture, TableFormat::single, filter == ShaderFilter::hardware));
  for (const MapTexture& texture : shader.maps.textures) function.set_texture(texture, single_maps);
  std::vector<float> places;
  std::vector<GlVectors> directions;
  for (const Question& q : questions) {
    for (const double x : {q.u, q.v, q.lod}) places.push_back(static_cast<float>(x));
    const auto wi = to_floats(q.wi), wo = to_floats(q.wo);
    directions.push_back({{wi[0], wi[1], wi[2]}, {wo[0], wo[1], wo[2]}});
  }
  function.set_numbers(places);
  return function.call(directions);
}

// Units weigh texels, and levels, with eight bits at least: that much of the largest value beside it.
TEST_F(GlSpatial, ShaderAgreesWithTheEvaluator) {
  const SpatialBrdf surface = random_surface(16, 8);
  const SpatialEvaluator evaluator(surface);
  const std::vector<Question> asked = questions(surface, 3000);
  for (const auto& [filter, single, most] : {std::tuple{ShaderFilter::exact, true, 0.01},
                                             {ShaderFilter::hardware, true, 0.015},
                                             {ShaderFilter::hardware, false, 0.03}}) {
    const std::vector<float> found = answers(surface, asked, filter, single);
    std::vector<double> off;
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const Question& q = asked[i];
      std::array<float, 3> truth{};
      evaluator.eval(evaluator.place(q.u, q.v, q.lod), q.wi, q.wo, truth);
      const float largest = std::ranges::max(truth);
      for (std::size_t c = 0; c < 3; ++c)
        off.push_back(static_cast<double>(std::abs(found[3 * i + c] - truth[c]) / largest));
    }
    std::ranges::sort(off);
    EXPECT_LT(off[off.size() / 2], most / 10);
    EXPECT_LT(off[off.size() * 99 / 100], most);
  }
}

// Blocks store smooth maps with small errors: half a step or two of 8 bits for weights, and one step of 127 for
// normals.
TEST_F(GlSpatial, ReadsMapsInBlocks) {
  const SpatialBrdf surface = smooth_surface(64);
  const SpatialEvaluator evaluator(surface);
  const std::vector<Question> asked = questions(surface, 3000);
  const std::vector<float> found = answers(surface, asked, ShaderFilter::hardware, false, true);
  std::vector<double> off;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Question& q = asked[i];
    std::array<float, 3> truth{};
    evaluator.eval(evaluator.place(q.u, q.v, q.lod), q.wi, q.wo, truth);
    for (std::size_t c = 0; c < 3; ++c)
      off.push_back(static_cast<double>(std::abs(found[3 * i + c] - truth[c]) / std::ranges::max(truth)));
  }
  std::ranges::sort(off);
  EXPECT_LT(off[off.size() / 2], 0.01);
  EXPECT_LT(off[off.size() * 99 / 100], 0.1);
}

constexpr int kSpatialSize = 160;

Image drawn(const Scene& scene, const SpatialBrdf& surface) {
  const GlRenderer renderer(scene,
                            std::array{surface_shader(surface, ShaderFilter::hardware, TableFormat::single)},
                            kSpatialSize, kSpatialSize);
  renderer.draw();
  return renderer.read();
}

TEST_F(GlSpatial, RendererAgreesWithTheReference) {
  // fine maps on the sphere, so that levels count; coarse ones on the plane
  for (const auto& [shape, side] : {std::pair{Shape::sphere, 512}, {Shape::plane, 16}}) {
    const SpatialBrdf surface = smooth_surface(side);
    Scene scene;
    scene.parts = {{make_shape(shape, 4000), 0}};
    scene.lights = {{{2, 3, 4}, 20}, {{-3, 1, 3}, {9, 6, 3}}};
    scene.camera = camera_for_unit_sphere(0.3, 0.2);
    const Image truth = render_cpu(scene, std::array<SceneMaterial, 1>{&surface},
                                   {.width = kSpatialSize, .height = kSpatialSize});
    const double exposure = 1 / percentile(truth.pixels, 0.97);
    EXPECT_GT(psnr(mean_squared_error(tone_map(drawn(scene, surface), exposure), tone_map(truth, exposure))),
              40)
        << side;
  }
}

}  // namespace
}  // namespace burnish
