// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/capture/pictures/btf_file.h>
#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/pictures/picture_rows.h>
#include <burnish/capture/surface_fit.h>
#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/testing/btf.h>
#include <burnish/testing/captures.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;

struct Written {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path / "a.btf";

  Written(const std::string& name, const std::string& bytes) : folder("btf_" + name) { write(path, bytes); }
  Written(const std::string& name, const BtfContent& content) : Written(name, btf_bytes(content)) {}
};

/// Returns the colours of a texel, computed in double as in the owners' undecorrelate.m.
std::array<double, 3> colour(const BtfContent& content, std::size_t picture, std::size_t texel) {
  constexpr double kEps = 1e-5;
  double y = content.product(0, picture, texel), u = content.product(1, picture, texel),
         v = content.product(2, picture, texel);
  const auto sign = [](double x) { return static_cast<double>((x > 0) - (x < 0)); };
  switch (content.colours) {
    case 0:
      return {y, u, v};
    case 3: {
      std::array<double, 3> sum{};
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] = static_cast<double>(content.mean[c]) + y * static_cast<double>(content.transform[c]) +
                 u * static_cast<double>(content.transform[3 + c]) +
                 v * static_cast<double>(content.transform[6 + c]);
      return sum;
    }
    case 4:
      return {y + u - v, y + v, y - u - v};
    case 9:
      y = std::exp(y) - kEps;
      break;
    case 10:
      y = std::exp(y) - kEps;
      u = sign(u) * std::exp(std::abs(u) + std::log(kEps));
      v = sign(v) * std::exp(std::abs(v) + std::log(kEps));
      break;
    case 11:
      y = std::exp(y) - kEps;
      u *= y + kEps;
      v *= y + kEps;
      break;
    case 12:
      return {std::exp(y) - kEps, std::exp(u) - kEps, std::exp(v) - kEps};
    default:
      break;
  }
  return {y + 1.13983 * v, y - 0.39465 * u - 0.5806 * v, y + 2.03211 * u};
}

TEST(BtfFile, HoldsWhatTheOwnersReaderGives) {
  for (const std::int32_t colours : {0, 1, 3, 4, 9, 10, 11, 12})
    for (const int scalar : {2, 4, 8})
      for (const bool texels_first : {false, true}) {
        BtfContent content = btf_content();
        content.colours = colours;
        content.scalar_bytes = scalar;
        content.texels_first = texels_first;
        content.mean = {0.25f, 0.5f, -0.125f};
        content.transform = {1, 0.5f, 0, -0.25f, 2, 0.125f, 0, 0.75f, 1};
        content.version = static_cast<std::uint32_t>(1 + scalar / 2);
        const Written written("reads", content);
        EXPECT_TRUE(BtfFile::recognizes(written.path));
        const BtfFile file(written.path);
        EXPECT_EQ(file.width(), 5);
        EXPECT_EQ(file.height(), 2);
        EXPECT_EQ(file.pictures(), 6u);
        const BtfFile::Rows rows = file.rows(0, 2);
        for (std::size_t picture = 0; picture < file.pictures(); ++picture) {
          const Image image = rows.picture(picture);
          for (std::size_t texel = 0; texel < 10; ++texel)
            for (std::size_t c = 0; c < 3; ++c)
              EXPECT_NEAR(image.pixels[3 * texel + c], colour(content, picture, texel)[c], 2e-6)
                  << colours << ' ' << scalar << ' ' << texels_first;
          // Rows that are read alone have the same bits.
          const Image second = file.rows(1, 1).picture(picture);
          EXPECT_TRUE(std::equal(second.pixels.begin(), second.pixels.end(), image.pixels.begin() + 15));
        }
        EXPECT_NEAR(length(file.lights()[2] - spherical_direction(1.2, -2)), 0, 1e-7);
        EXPECT_NEAR(length(file.views()[1] - spherical_direction(0.7, 3)), 0, 1e-7);
      }
}

TEST(BtfFile, IsACapture) {
  BtfContent content = btf_content();
  content.lights.push_back({0.3f, 2});
  for (std::size_t c = 0; c < 3; ++c) content.pictures[c].resize(8 * content.components[c], 0.5);
  for (const std::uint32_t with_cosine : {0u, 1u}) {
    content.with_cosine = with_cosine;
    const Written written("capture", content);
    const Capture capture(written.path);
    const CaptureForm& form = capture.form();
    ASSERT_EQ(form.pictures.size(), 8u);
    EXPECT_TRUE(form.directional());
    EXPECT_NEAR(form.size_x, 0.5, 1e-7);  // mm
    EXPECT_NEAR(form.size_y, 0.2, 1e-7);
    const Image image = BtfFile(written.path).rows(1, 1).picture(5);
    const CaptureRows rows = capture.read(1, 1).rows;
    const auto cosine = static_cast<float>(std::cos(content.lights[1][0]));
    for (std::size_t i = 0; i < 15; ++i)  // f cos(theta_i), with or without the cosine in the file
      EXPECT_NEAR(rows.values[5 * 15 + i], image.pixels[i] * (with_cosine != 0 ? 1 : cosine), 1e-6);
    // Fewer pictures are spread over all of them, and have another fingerprint.
    const Capture fewer(written.path, 4);
    ASSERT_EQ(fewer.form().pictures.size(), 4u);
    EXPECT_EQ(fewer.form().pictures[1], form.pictures[2]);
    EXPECT_NE(fewer.fingerprint(), capture.fingerprint());
    EXPECT_THROW(Capture(written.path, 3), Error);
    // A file that was written again has another fingerprint.
    std::filesystem::last_write_time(
        written.path, std::filesystem::last_write_time(written.path) + std::chrono::seconds(2));
    EXPECT_NE(Capture(written.path).fingerprint(), capture.fingerprint());
  }
}

// The pictures of a folder, written as a BTF with one component a picture, are fitted with the same score.
TEST(BtfFile, IsFittedAsAFolderOfItsPictures) {
  const TemporaryFolder folder("btf_fit");
  SurfaceScene scene = small_scene(16, 12, R"("noise":0.01,"held_out":12,"shadows":false)");
  std::ranges::fill(scene.heights, 0.0f);
  write_virtual_capture(scene, folder.path);
  const Capture capture(folder.path);
  const CaptureForm& form = capture.form();
  BtfContent content = btf_content();
  content.width = content.height = 16;
  content.with_cosine = 1;
  content.lights.clear();
  content.views.clear();
  const auto angles = [](Vec3 v) {
    return std::array{static_cast<float>(theta_of(v)), static_cast<float>(std::atan2(v.y, v.x))};
  };
  for (const CapturePicture& picture : form.pictures) {
    if (picture.view == form.pictures.front().view) content.lights.push_back(angles(picture.light.at));
    if (picture.light == form.pictures.front().light) content.views.push_back(angles(picture.view.at));
  }
  const std::size_t count = form.pictures.size(), lights = content.lights.size();
  ASSERT_EQ(content.picture_count(), count);
  content.components = {count, count, count};
  const CaptureRows rows = capture.read(0, 16).rows;
  for (std::size_t c = 0; c < 3; ++c) {
    content.pictures[c].assign(count * count, 0);
    content.texels[c].assign(rows.texels() * count, 0);
    for (std::size_t p = 0; p < count; ++p) {
      const auto where = [&](const Station& station, const auto& list) {
        const auto found = std::ranges::find(list, angles(station.at));
        return static_cast<std::size_t>(found - list.begin());
      };
      const std::size_t number = where(form.pictures[p].light, content.lights) +
                                 lights * where(form.pictures[p].view, content.views);
      content.pictures[c][number * count + p] = 1;
      for (std::size_t t = 0; t < rows.texels(); ++t)
        content.texels[c][t * count + p] = static_cast<double>(rows.values[(p * rows.texels() + t) * 3 + c]);
    }
  }
  const Written written("fit", content);
  SurfaceFitOptions options;
  options.lobes = 2;
  options.lobe_bytes = 1024;
  options.rounds = 2;
  options.normals = NormalsFrom::flat;
  const SurfaceReport of_folder = fit_surface(Capture(folder.path), options).report,
                      of_btf = fit_surface(Capture(written.path), options).report;
  EXPECT_EQ(of_btf.pictures, count);
  EXPECT_NEAR(of_btf.fitted.psnr.value(), of_folder.fitted.psnr.value(), 0.5);
  EXPECT_GT(of_btf.held_out.psnr.value(), 40);
}

TEST(BtfFile, RefusesWhatItCannotRead) {
  const std::string whole = btf_bytes(btf_content());
  for (std::size_t size = 3; size < whole.size(); size += size < 500 ? 1 : 13) {
    const Written cut("cut", whole.substr(0, size));
    EXPECT_THROW(BtfFile(cut.path), Error) << size;
  }
  const auto message = [](const BtfContent& content) -> std::string {
    try {
      BtfFile(Written("refused", content).path);
    } catch (const Error& error) {
      return error.what();
    }
    return "read";
  };
  const auto changed = [&](const std::function<void(BtfContent&)>& change) {
    BtfContent content = btf_content();
    change(content);
    return message(content);
  };
  EXPECT_EQ(changed([](BtfContent&) {}), "read");
  EXPECT_THAT(changed([](BtfContent& c) { c.colours = 2; }),
              HasSubstr("expected colour model 0, 1, 3, 4 or 9 to 12, found 2"));
  EXPECT_THAT(changed([](BtfContent& c) { c.lights[1][0] = 1.6f; }),
              HasSubstr("expected light above the surface"));
  EXPECT_THAT(changed([](BtfContent& c) { c.views[1][1] = NAN; }),
              HasSubstr("expected view above the surface"));
  EXPECT_THAT(changed([](BtfContent& c) { c.scalar_bytes = 3; }),
              HasSubstr("expected numbers of 2, 4 or 8 bytes"));
  EXPECT_THAT(changed([](BtfContent& c) { c.width = 4; }),
              HasSubstr("expected matrices of 6 and 8 rows, found 6 and 10"));
  EXPECT_THAT(changed([](BtfContent& c) { c.width = 40'000; }), HasSubstr("expected width of 1 to 16384"));
  std::string other = whole;
  other.replace(0, 10, "!FMF12FCER");
  EXPECT_TRUE(BtfFile::recognizes(Written("other", other).path));
  EXPECT_THROW(BtfFile(Written("other", other).path), Error);
  const Written good("short", whole);
  const BtfFile file(good.path);
  std::filesystem::resize_file(good.path, whole.size() - 4);
  EXPECT_THROW(file.rows(0, 2), Error);
  EXPECT_THROW(file.rows(1, 2), Error);
}

}  // namespace
}  // namespace burnish
