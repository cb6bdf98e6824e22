// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/surface_baselines.h>
#include <burnish/capture/surface_fit.h>
#include <burnish/capture/surface_picture.h>
#include <burnish/error.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/captures.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;

const std::string kHead = "texel_x,texel_y,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r,g,b\n";

std::string row(int x, int y, Vec3 wi, Vec3 wo, float f) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", x, y, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, f, 2 * f,
                     3 * f);
}

TEST(TexelTable, GivesEachTexelItsSamplesInOrder) {
  const TemporaryFolder folder("texel_table");
  const fs::path file = folder.path / "samples.csv";
  const Vec3 up{0, 0, 1}, tilted{0.6, 0, 0.8};
  std::string text = kHead;
  for (int k = 0; k < 14; ++k) text += row(1, 0, tilted, up, static_cast<float>(k));
  text += row(0, 1, up, tilted, 7) + row(1, 0, up, up, 14);
  write(file, text);
  const Capture capture(file);
  EXPECT_EQ(capture.form().width, 2);
  EXPECT_EQ(capture.form().height, 2);
  EXPECT_FALSE(capture.form().directional());
  // The twelfth of fifteen samples is held out.
  ASSERT_EQ(capture.form().pictures.size(), 15u);
  for (std::size_t p = 0; p < 15; ++p) EXPECT_EQ(capture.form().pictures[p].held_out, p == 14);

  const CaptureRows rows = capture.read(0, 2).rows;
  const auto pixel = [](std::size_t p, std::size_t t) { return p * 4 + t; };
  for (std::size_t p = 0; p < 15; ++p) {
    const float f = p == 14 ? 11 : p < 11 ? static_cast<float>(p) : static_cast<float>(p + 1);
    const float cosine = f == 14 ? 1 : 0.8f;
    EXPECT_EQ(rows.states[pixel(p, 1)], PixelState::there);
    EXPECT_FLOAT_EQ(rows.values[3 * pixel(p, 1) + 2], 3 * f * cosine);
    EXPECT_EQ(rows.directions[6 * pixel(p, 1) + 2], cosine);
    for (const std::size_t t : {0u, 2u, 3u})
      EXPECT_EQ(rows.states[pixel(p, t)], t == 2 && p == 0 ? PixelState::there : PixelState::missing);
  }
  EXPECT_EQ(rows.directions[6 * pixel(0, 2) + 3], 0.6f);
  // A row that is read alone is the same.
  const CaptureRows second = capture.read(1, 1).rows;
  EXPECT_EQ(second.values[0], rows.values[3 * pixel(0, 2)]);
  EXPECT_EQ(second.states[0], PixelState::there);
}

TEST(TexelTable, RefusesWhatIsNoSurface) {
  const TemporaryFolder folder("texel_table_refuses");
  const fs::path file = folder.path / "samples.csv";
  const Vec3 up{0, 0, 1};
  for (const std::string& rows : {std::string(), row(9000, 9000, up, up, 1), row(0, 0, up, up, 1)}) {
    write(file, kHead + rows);
    EXPECT_THROW(Capture{file}, Error) << rows;
  }
}

/// Writes the pictures of a folder as samples of texels, with the held-out ones.
void write_as_samples(const Capture& capture, const fs::path& file) {
  const CaptureForm& form = capture.form();
  const CaptureRows rows = capture.read(0, form.height).rows;
  std::string text = "held_out," + kHead;
  for (std::size_t p = 0; p < rows.pictures; ++p)
    for (std::size_t t = 0; t < rows.texels(); ++t) {
      const int x = static_cast<int>(t) % form.width, y = static_cast<int>(t) / form.width;
      const Vec3 wi = form.pictures[p].light.seen_from(form.point(x, y)),
                 wo = form.pictures[p].view.seen_from(form.point(x, y));
      text += fmt::format("{},{},{},{},{},{},{},{},{}", form.pictures[p].held_out ? 1 : 0, x, y, wi.x, wi.y,
                          wi.z, wo.x, wo.y, wo.z);
      for (std::size_t c = 0; c < 3; ++c)
        text += fmt::format(",{}", static_cast<double>(rows.values[3 * (p * rows.texels() + t) + c]) / wi.z);
      text += '\n';
    }
  write(file, text);
}

SurfaceFitOptions few_options() {
  SurfaceFitOptions options;
  options.lobes = 2;
  options.lobe_bytes = 1024;
  options.rounds = 3;
  return options;
}

TEST(SurfaceFit, OfSamplesIsThatOfPictures) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const TemporaryFolder folder("texel_samples");
  small_capture(folder.path, 24, 12, R"("noise":0.01,"held_out":6,"shadows":false)");
  write_as_samples(Capture(folder.path), folder.path / "samples.csv");
  SurfaceFitOptions options = few_options();
  options.normals = NormalsFrom::flat;
  const SurfaceFit pictures = fit_surface(Capture(folder.path), options),
                   samples = fit_surface(Capture(folder.path / "samples.csv"), options);
  EXPECT_EQ(samples.report.pictures, pictures.report.pictures);
  EXPECT_TRUE(samples.report.of_samples);
  // Directions are rounded to floats, so scores differ a little.
  EXPECT_NEAR(samples.report.held_out.psnr.value(), pictures.report.held_out.psnr.value(), 0.01);
  EXPECT_NEAR(samples.report.fitted.psnr.value(), pictures.report.fitted.psnr.value(), 0.01);
  // The surface has bumps, which estimated normals find.
  options.normals = NormalsFrom::estimate;
  EXPECT_GT(fit_surface(Capture(folder.path / "samples.csv"), options).report.held_out.psnr.value(),
            samples.report.held_out.psnr.value() + 8);
}

TEST(SurfaceFit, OfSamplesPredictsThoseThatWereHeldOut) {
  BURNISH_SKIP_WHERE_SANITIZED();
  // Each texel has its own directions, and its own number of them. Half the surface is another material.
  const TemporaryFolder folder("texel_own");
  const AnalyticBrdf left = parse_analytic("lambert:kd=0.5/0.2/0.1"),
                     right = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.8/0.6/0.3");
  std::string text = kHead;
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 12; ++x) {
      const auto count = static_cast<std::size_t>(40 - (x + 2 * y) % 7);
      for (const DirectionPair& pair : draw_pairs(count, static_cast<std::uint64_t>(12 * y + x + 1), true)) {
        if (pair.wi.z < 0.2 || pair.wo.z < 0.2) continue;
        std::array<double, 3> f;
        (x < 6 ? left : right).ref().eval(pair.wi, pair.wo, f);
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", x, y, pair.wi.x, pair.wi.y, pair.wi.z,
                            pair.wo.x, pair.wo.y, pair.wo.z, f[0], f[1], f[2]);
      }
    }
  write(folder.path / "own.csv", text);
  const SurfaceFit fit = fit_surface(Capture(folder.path / "own.csv"), few_options());
  EXPECT_EQ(fit.report.normals, NormalsFrom::flat);
  EXPECT_EQ(fit.report.missing_pixels, 0u);
  EXPECT_GT(fit.report.held_out.psnr.value(), 38);
  const auto others = score_surface_baselines(Capture(folder.path / "own.csv"), fit, few_options());
  for (const BaselineScore& other : others)
    EXPECT_EQ(other.held_out.has_value(), other.method != "pca") << other.method;
  EXPECT_THROW(surface_picture(Capture(folder.path / "own.csv"), fit.surface.brdf, 0, 1), Error);
}

}  // namespace
}  // namespace burnish
