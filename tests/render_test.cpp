// SPDX-License-Identifier: Apache-2.0
// These tests check what `burnish render` draws and what it refuses.

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <burnish/error.h>
#include <burnish/factors/model_file.h>
#include <burnish/image/png.h>
#include <burnish/render/gl/gl_context.h>
#include <burnish/render/picture.h>
#include <burnish/testing/models.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

bool has_opengl() {
  try {
    const GlContext context;
    return true;
  } catch (const Error&) {
    return false;
  }
}

class Render : public testing::Test {
 protected:
  void SetUp() override {
    write(folder_ / "one.exr", format_model({smooth_model(model_case("Pqp")), {}, "{}"}));
    write(folder_ / "two.exr", format_model({smooth_model(model_case("Mirror")), {}, "{}"}));
    write(folder_ / "brushed.exr", format_model({smooth_model(model_case("DiskPqp")), {}, "{}"}));
    write(folder_ / "two.obj",
          "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl left\nf 1 2 4\nusemtl right\nf 2 3 4\n");
  }
  int renders(const std::string& arguments) const {
    return run(fmt::format("cd '{}' && {} render {} > said 2>&1", folder_.string(), BURNISH_CLI, arguments))
        .status;
  }
  std::string said() const { return read(folder_ / "said"); }
  Image8 picture(const char* name) const { return read_png(folder_ / name); }

  TemporaryFolder scratch_{"render"};
  const fs::path folder_ = scratch_.path;
};

double mean_difference_of(const Image8& a, const Image8& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i)
    sum += std::abs(a.pixels[i] - b.pixels[i]);
  return sum / static_cast<double>(a.pixels.size());
}

TEST_F(Render, BothRenderersDrawTheSamePicture) {
  if (!has_opengl()) GTEST_SKIP() << "no OpenGL";
  for (const std::string scene :
       {"--mesh torus-knot --material one.exr", "--mesh two.obj --material one.exr --material two.exr"}) {
    const std::string common =
        scene +
        " --vertices 2000 --size 64x48 --lights 2,3,4:20 --lights -3,1,2:4,5,9 --view 20,10 --exposure 2 -o ";
    ASSERT_EQ(renders(common + "gl.png"), 0) << said();
    ASSERT_EQ(renders(common + "cpu.png --renderer cpu"), 0) << said();
    EXPECT_EQ(picture("gl.png").width, 64);
    EXPECT_EQ(picture("gl.png").height, 48);
    EXPECT_LT(mean_difference_of(picture("gl.png"), picture("cpu.png")), 0.5);
    EXPECT_GT(mean_difference_of(picture("gl.png"), Image8(64, 48, 3)), 5) << "something is there";
  }
}

TEST_F(Render, LightFromAllAroundIsTheReferencesToo) {
  if (!has_opengl()) GTEST_SKIP() << "no OpenGL";
  Image sky(64, 32, 3);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        sky.at(x, y)[c] = x > 8 && x < 20 && y > 6 && y < 14 ? 8.0f : 0.2f + 0.1f * static_cast<float>(c);
  write(folder_ / "sky.exr", encode_exr(sky));
  for (const char* scene :
       {"one.exr --environment sky.exr", "brushed.exr --environment sky.exr --lights 2,3,4:5"}) {
    const std::string common = fmt::format(
        "--mesh torus-knot --vertices 3000 --size 48 --samples 1 --exposure 1 --material {} -o ", scene);
    ASSERT_EQ(renders(common + "gl.png"), 0) << said();
    ASSERT_EQ(renders(common + "cpu.png --renderer cpu --draws 64"), 0) << said();
    EXPECT_LT(mean_difference_of(picture("gl.png"), picture("cpu.png")), 2) << scene;
    EXPECT_GT(mean_difference_of(picture("gl.png"), Image8(48, 48, 3)), 10) << "something is there";
  }
  EXPECT_EQ(renders("--material one.exr --environment no_such.exr -o x.png"), 1);
  write(folder_ / "sky.exr", "v/1\x01 no picture");
  EXPECT_EQ(renders("--material one.exr --environment sky.exr -o x.png"), 1);
  EXPECT_THAT(said(), AllOf(HasSubstr("sky.exr"), HasSubstr("expected")));
}

TEST_F(Render, DrawsAnyBrdfByTheReferenceRendererAndExr) {
  ASSERT_EQ(
      renders("--mesh teapot --vertices 1000 --size 32 --material ggx:alpha_x=0.2,alpha_y=0.4 --renderer cpu "
              "--shadows --tone aces -o t.png"),
      0)
      << said();
  ASSERT_EQ(renders("--size 16 --material lambert --renderer cpu -o t.exr"), 0) << said();
  EXPECT_EQ(read(folder_ / "t.exr").substr(0, 4), "\x76\x2f\x31\x01");
}

TEST_F(Render, RefusesWhatItCannotDrawAndLeavesNothing) {
  const std::string good = "--size 16 --material one.exr ";
  EXPECT_EQ(renders(good + "-o x.jpg"), 2);
  EXPECT_EQ(renders(good + "-o x.png --lights 1,2"), 2);
  EXPECT_THAT(said(), HasSubstr("--lights"));
  EXPECT_EQ(renders(good + "-o x.png --renderer gl --shadows"), 2);
  EXPECT_EQ(renders(good + "-o x.png --size 0"), 2);
  EXPECT_EQ(renders(good + "-o x.png --background 1,-1,1"), 2);
  EXPECT_EQ(renders("-o x.png"), 2);
  EXPECT_EQ(renders("--size 16 --material ggx -o drawn.png"), 0) << said();  // by the renderer that can
  EXPECT_EQ(renders("--material ggx --renderer gl -o x.png"), 1);
  EXPECT_THAT(said(), HasSubstr("--renderer cpu"));
  EXPECT_EQ(renders(good + "--mesh none.obj -o x.png"), 1);
  write(folder_ / "bad.obj", "v 0 0 0\nf 1 2 3\n");
  EXPECT_EQ(renders(good + "--mesh bad.obj -o x.png"), 1);
  EXPECT_THAT(said(), AllOf(HasSubstr("bad.obj: line 2"), HasSubstr("expected")));
  EXPECT_EQ(renders("--figure1 --mesh bad.obj -o x.png"), 2);
  EXPECT_FALSE(fs::exists(folder_ / "x.png"));
}

TEST_F(Render, FigureComparesVerticesWithPixels) {
  if (!has_opengl()) GTEST_SKIP() << "no OpenGL";
  // The model is its own truth here, so pixels are right and vertices are not.
  ASSERT_EQ(
      renders(
          "--figure1 --mesh sphere --truth one.exr --model one.exr --tessellations 200,800 --figure-size 64 "
          "--json -o figure.png"),
      0)
      << said();
  EXPECT_THAT(said(),
              AllOf(HasSubstr("psnr_at_vertices"), HasSubstr("psnr_factored"), HasSubstr("\"vertices\": 8")));
  EXPECT_GT(picture("figure.png").width, 5 * 64);
}

}  // namespace
}  // namespace burnish
