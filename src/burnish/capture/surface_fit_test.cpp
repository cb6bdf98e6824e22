// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/capture/surface_baselines.h>
#include <burnish/capture/surface_fit.h>
#include <burnish/capture/surface_picture.h>
#include <burnish/error.h>
#include <burnish/image/png.h>
#include <burnish/math/parallel.h>
#include <burnish/testing/captures.h>
#include <burnish/testing/crews.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;

SurfaceFitOptions small_options(std::size_t lobes = 2) {
  SurfaceFitOptions options;
  options.lobes = lobes;
  options.lobe_bytes = 1024;
  options.rounds = 2;
  return options;
}

/// 28 x 28 texels of two materials under 12 lights from two sides.
struct SmallCapture {
  TemporaryFolder folder;
  explicit SmallCapture(const std::string& name, const std::string& more = "")
      : folder("surface_fit_" + name) {
    small_capture(folder.path, 28, 12, R"("noise":0.01,"held_out":6)" + (more.empty() ? "" : "," + more));
  }
  SurfaceFit fit(const SurfaceFitOptions& options) const {
    return fit_surface(Capture(folder.path), options);
  }
};

TEST(SurfaceFit, PredictsPicturesThatWereHeldOut) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const SmallCapture capture("predicts");
  SurfaceFitOptions options = small_options();
  options.rounds = 5;
  const SurfaceFit fit = capture.fit(options);
  EXPECT_EQ(fit.report.held_out.pictures, 4u);
  EXPECT_GT(fit.report.held_out.psnr.value(), 38);
  EXPECT_GT(fit.report.fitted.psnr.value(), 38);
  EXPECT_EQ(fit.report.weight_bytes, 2u);
  EXPECT_EQ(fit.report.normals, NormalsFrom::capture);
  EXPECT_EQ(parse_surface(memory_file(format_surface(fit.surface))), fit.surface);
}

TEST(SurfaceFit, FindsNormalsWhereTheCaptureHasNone) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const SmallCapture capture("normals", R"("normals":false)");
  SurfaceFitOptions options = small_options();
  options.rounds.reset();
  const SurfaceFit fit = capture.fit(options);
  EXPECT_EQ(fit.report.normals, NormalsFrom::estimate);
  EXPECT_GT(fit.report.held_out.psnr.value(), 45);
  options.normals = NormalsFrom::flat;
  EXPECT_LT(capture.fit(options).report.held_out.psnr.value(), fit.report.held_out.psnr.value() - 3);
  options.normals = NormalsFrom::capture;
  EXPECT_THROW(capture.fit(options), Error);
}

TEST(SurfaceFit, TakesTheLobesOfABook) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const SmallCapture capture("book");
  SurfaceFitOptions options = small_options();
  const SurfaceFit first = capture.fit(options);
  options.book = first.surface.brdf.lobes();
  const SurfaceFit second = capture.fit(options);
  EXPECT_EQ(second.surface.brdf.lobes(), first.surface.brdf.lobes());
  EXPECT_EQ(second.surface.brdf.maps(), first.surface.brdf.maps());
}

// The result has the same bytes for any number of threads and any size of tiles.
TEST(SurfaceFit, GivesTheSameBytesForAnyThreadsAndTiles) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const SmallCapture capture("threads");
  SurfaceFitOptions options = small_options();
  const std::string all = format_surface(capture.fit(options).surface);
  const ThreadLimit one(1);
  options.tile_bytes = 50'000;
  EXPECT_EQ(format_surface(capture.fit(options).surface), all);
}

// The first rounds see only a part of many sampled texels.
TEST(SurfaceFit, GivesTheSameBytesForAnyThreadsOfManyTexels) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const TemporaryFolder folder("surface_fit_many");
  small_capture(folder.path, 56, 6, R"("noise":0.01,"held_out":6)");
  SurfaceFitOptions options = small_options();
  options.rounds = 4;
  const SurfaceFit all = fit_surface(Capture(folder.path), options);
  EXPECT_GT(all.report.held_out.psnr.value(), 30);
  const ThreadLimit one(1);
  EXPECT_EQ(format_surface(fit_surface(Capture(folder.path), options).surface), format_surface(all.surface));
}

// A fit that stops anywhere resumes from its checkpoint and ends in the same bytes.
TEST(SurfaceFit, GoesOnFromACheckpoint) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const SmallCapture capture("resume");
  SurfaceFitOptions options = small_options();
  options.tile_bytes = 50'000;
  const std::string whole = format_surface(capture.fit(options).surface);
  options.checkpoint = capture.folder.path / "fit.part";
  for (const double where : {0.01, 0.5, 0.9}) {
    fs::remove(options.checkpoint);
    SurfaceFitOptions stopped = options;
    stopped.progress = [&](std::string_view stage, double fraction) {
      if (stage == "fitting weights" && fraction > where) throw Error("stopped");
    };
    EXPECT_THROW(capture.fit(stopped), Error);
    ASSERT_TRUE(fs::exists(options.checkpoint));
    const SurfaceFit resumed = capture.fit(options);
    EXPECT_GT(resumed.report.resumed_rows, 0);
    EXPECT_EQ(format_surface(resumed.surface), whole) << where;
  }
  // A checkpoint of other options or pictures is refused, and so is a damaged one.
  options.seed = 2;
  EXPECT_THROW(capture.fit(options), Error);
  options.seed = 1;
  EXPECT_NO_THROW(capture.fit(options));
  write(capture.folder.path / "00003.exr", read(capture.folder.path / "00004.exr"));
  EXPECT_THAT(error_of([&] { capture.fit(options); }), testing::HasSubstr("a checkpoint of this capture"));
  write(options.checkpoint, read(options.checkpoint).substr(0, 1000));
  EXPECT_THROW(capture.fit(options), Error);
}

// A fit also resumes from rounds of lobes: the first, on a part of the texels, and later ones.
TEST(SurfaceFit, GoesOnFromARoundOfLobes) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const TemporaryFolder folder("surface_fit_rounds");
  small_capture(folder.path, 56, 6, R"("noise":0.01,"held_out":6)");
  SurfaceFitOptions options = small_options();
  options.rounds = 4;
  options.normals = NormalsFrom::estimate;
  const auto fit = [&](const SurfaceFitOptions& own) { return fit_surface(Capture(folder.path), own); };
  const std::string whole = format_surface(fit(options).surface);
  options.checkpoint = folder.path / "fit.part";
  for (const int rounds : {1, 3}) {
    fs::remove(options.checkpoint);
    SurfaceFitOptions stopped = options;
    stopped.progress = [&](std::string_view stage, double fraction) {
      if (stage == "fitting lobes" && fraction * 4 > rounds) throw Error("stopped");
    };
    EXPECT_THROW(fit(stopped), Error);
    ASSERT_TRUE(parse_lobes_checkpoint(read_file(options.checkpoint)).has_value());
    const SurfaceFit resumed = fit(options);
    EXPECT_EQ(resumed.report.resumed_rounds, rounds);
    EXPECT_TRUE(format_surface(resumed.surface) == whole) << rounds;
  }
}

TEST(SurfaceFit, IsTheSameForAnyNumberOfRanks) {
  const SmallCapture folder("ranks");
  SurfaceFitOptions options = small_options();
  options.rounds = 2;
  std::string alone = format_surface(folder.fit(options).surface);
  for (const int ranks : {2, 3}) {
    if (ranks == 3) {  // and estimated normals
      options.normals = NormalsFrom::estimate;
      alone = format_surface(folder.fit(options).surface);
    }
    ThreadCrew crew(ranks);
    std::vector<std::thread> helpers;
    for (int rank = 1; rank < ranks; ++rank)
      helpers.emplace_back([&, rank] {
        ThreadCrew::Member member(crew, rank);
        SurfaceFitOptions own = options;
        own.crew = &member;
        help_fit_surface(Capture(folder.folder.path), own);
      });
    ThreadCrew::Member leader(crew, 0);
    SurfaceFitOptions own = options;
    own.crew = &leader;
    EXPECT_EQ(format_surface(folder.fit(own).surface), alone) << ranks;
    for (std::thread& helper : helpers) helper.join();
  }
}

TEST(SurfaceFit, SaysWhichPicturesItLeftOut) {
  const SmallCapture capture("left_out");
  const fs::path cut = capture.folder.path / "00001.exr";
  const std::string bytes = read(cut);
  write(cut, bytes.substr(0, bytes.size() - 500));
  const SurfaceFit fit = capture.fit(small_options());
  ASSERT_EQ(fit.report.left_out.size(), 1u);
  EXPECT_EQ(fit.report.left_out.front().file, "00001.exr");
  EXPECT_EQ(fit.report.pictures, 23u);
}

// Texels are counted that are masked in all fitted pictures, also if the fit was resumed.
TEST(SurfaceFit, CountsTexelsWithoutData) {
  const TemporaryFolder folder("surface_fit_without_data");
  CaptureForm form = small_capture(folder.path, 16, 6, R"("held_out":6)");
  Image8 mask(16, 16, 3);
  std::ranges::fill(mask.pixels, std::uint8_t{255});
  for (const auto& [x, y] : {std::pair{3, 0}, {4, 0}, {7, 15}})
    for (std::size_t c = 0; c < 3; ++c) mask.at(x, y)[c] = 0;
  write_png(folder.path / "mask.png", mask);
  for (CapturePicture& picture : form.pictures)
    if (!picture.held_out) picture.mask = "mask.png";
  write(folder.path / "capture.json", format_capture(form));
  SurfaceFitOptions options = small_options();
  options.tile_bytes = 1;
  options.checkpoint = folder.path / "fit.part";
  SurfaceFitOptions stopped = options;
  stopped.progress = [](std::string_view stage, double fraction) {
    if (stage == "fitting weights" && fraction > 0.5) throw Error("stopped");
  };
  EXPECT_THROW(fit_surface(Capture(folder.path), stopped), Error);
  const SurfaceReport report = fit_surface(Capture(folder.path), options).report;
  EXPECT_GT(report.resumed_rows, 0);
  EXPECT_EQ(report.texels_without_data, 3u);
  EXPECT_THAT(report_json(report), testing::HasSubstr(R"("texels_without_data":3)"));
}

// The captured picture and the model's picture, side by side, are alike.
TEST(SurfacePicture, ShowsWhatWasTakenBesideTheModel) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const SmallCapture folder("picture");
  const SurfaceFit fit = folder.fit(small_options());
  const Capture capture(folder.folder.path);
  const Image8 sheet = surface_picture(capture, fit.surface.brdf, 3, fit.report.exposure);
  ASSERT_EQ(sheet.width, 4 * 32 - 4);
  ASSERT_EQ(sheet.height, 28);
  double off = 0;
  for (int y = 0; y < 28; ++y)
    for (int x = 0; x < 28; ++x) off += std::abs(sheet.at(x, y)[0] - sheet.at(x + 32, y)[0]);
  EXPECT_LT(off / (28 * 28), 12);
  EXPECT_THROW(surface_picture(capture, fit.surface.brdf, 24, 1), Error);
}

// All methods are scored, and mixed lobes score best.
TEST(SurfaceBaselines, AreScoredBesideTheFit) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const SmallCapture capture("baselines");
  SurfaceFitOptions options = small_options();
  options.rounds = 4;
  const auto scores = score_surface_baselines(Capture(capture.folder.path), capture.fit(options), options);
  ASSERT_EQ(scores.size(), 4u);
  for (const BaselineScore& score : scores) {
    ASSERT_TRUE(score.held_out.has_value()) << score.method;
    EXPECT_GT(*score.held_out, 10) << score.method;
    if (score.method != "lobes" && score.method != "ggx") {  // one material is GGX itself
      EXPECT_GT(*scores.front().held_out, *score.held_out) << score.method;
    }
  }
}

TEST(SurfaceFit, RefusesOptionsOutOfRange) {
  const SmallCapture capture("options");
  const auto with = [&](auto change) {
    SurfaceFitOptions options = small_options();
    change(options);
    return [&capture, options] { capture.fit(options); };
  };
  EXPECT_THROW(with([](SurfaceFitOptions& o) { o.lobes = 0; })(), Error);
  EXPECT_THROW(with([](SurfaceFitOptions& o) { o.lobes = 17; })(), Error);
  EXPECT_THROW(with([](SurfaceFitOptions& o) { o.lobe_bytes = 10; })(), Error);
  for (const int rounds : {-5, 0, kMaxSurfaceRounds + 1})
    EXPECT_EQ(error_of(with([=](SurfaceFitOptions& o) { o.rounds = rounds; })),
              fmt::format("surface fit: expected 1 to 100 rounds, found {}", rounds));
}

}  // namespace
}  // namespace burnish
