// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/surface/surface_file.h>
#include <burnish/surface/widened_lobes.h>
#include <burnish/testing/models.h>
#include <burnish/testing/surfaces.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

constexpr int kSide = 32;
constexpr double kWidth = 0.12,
                 kBumps = 0.15;  // of slopes: the highlight's and, along each axis, the normals'

/// A highlight over theta_h beside a diffuse lobe.
FactoredBrdf highlight() {
  Table bell{.name = "z",
             .layout = {.width = 400, .warp = {WarpKind::power, 0.5}, .warp_y = {}, .warp_z = {}},
             .channels = 1,
             .values = {}};
  for (int x = 0; x < bell.layout.width; ++x) {
    const double z = std::max(node_direction(bell.layout, x, 0).z, 1e-3), square = 1 / (z * z) - 1;
    bell.values.push_back(static_cast<float>(std::max(1e-4, std::exp(-square / (2 * kWidth * kWidth)))));
  }
  return {3,
          {std::move(bell)},
          {{.scale = {2, 2, 2},
            .factors = {{.table = 0, .projection = kProjectHalf, .projection_y = {}, .projection_z = {}}}},
           {.scale = {0.1, 0.1, 0.1}, .factors = {}}}};
}

/// Normals that scatter normally, everywhere alike; the highlight in the left half alone.
SpatialBrdf bumpy() {
  Pcg32 random(3);
  std::vector<float> normals, left, all;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double r = kBumps * std::sqrt(-2 * std::log(1 - random.uniform())),
                   phi = 6.2831853 * random.uniform();
      for (const double slope : {r * std::cos(phi), r * std::sin(phi)})
        normals.push_back(static_cast<float>(slope / std::sqrt(1 + r * r)));
      left.push_back(x < kSide / 2 ? 1.0f : 0.0f);
      all.push_back(0.5f);
    }
  return {highlight(),
          {.weights = {SurfaceMap(kSide, kSide, 1, TableFormat::unorm8, 1, left),
                       SurfaceMap(kSide, kSide, 1, TableFormat::half, 1, all)},
           .normals = SurfaceMap(kSide, kSide, 2, TableFormat::half, 1, normals),
           .tangents = {}}};
}

double lit(const SpatialBrdf& surface, double u, double v, double lod, Vec3 wi, Vec3 wo) {
  const SpatialBrdf::Place place = surface.place(u, v, lod);
  std::array<double, 3> f{};
  const Vec3 li = place.frame.local(wi);
  surface.eval(place, li, place.frame.local(wo), f);
  return f[0] * std::max(li.z, 0.0);
}

// The relative error of a level of four times four texels, over directions about the highlight.
double error_of(const SpatialBrdf& surface, const SpatialBrdf& truth, int level) {
  double off = 0, all = 0;
  for (const double tilt : {0.0, 0.1, 0.2, 0.35})
    for (const double phi : {0.3, 2.0, 4.4}) {
      const Vec3 wi = normalize({tilt * std::cos(phi), tilt * std::sin(phi), 1}),
                 wo = normalize({0.1, 0.05, 1});
      const int side = kSide >> level;
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
          double mean = 0;
          for (int y = 0; y < 1 << level; ++y)
            for (int x = 0; x < 1 << level; ++x)
              mean +=
                  lit(truth, ((i << level) + x + 0.5) / kSide, ((j << level) + y + 0.5) / kSide, 0, wi, wo);
          mean /= 1 << (2 * level);
          const double found = lit(surface, (i + 0.5) / side, (j + 0.5) / side, level, wi, wo);
          off += (found - mean) * (found - mean);
          all += mean * mean;
        }
    }
  return std::sqrt(off / all);
}

TEST(WidenedLobes, ShowBumpsThatALevelHasNotAnyMore) {
  const SpatialBrdf surface = bumpy(), widened = with_widened_lobes(surface);
  ASSERT_GE(widened.widened().size(), 1u);
  for (const WidenedLobe& copy : widened.widened())
    EXPECT_EQ(copy.lobe, 0u);  // the diffuse one has no highlight
  EXPECT_GT(error_of(surface, surface, 4), 0.5);
  EXPECT_LT(error_of(widened, surface, 4), 0.12);
  EXPECT_LT(error_of(widened, surface, 5), 0.12);
}

TEST(WidenedLobes, LeaveLevelZeroAndWeightsAsTheyAre) {
  const SpatialBrdf surface = bumpy(), widened = with_widened_lobes(surface);
  const Vec3 wi = normalize({0.2, 0.1, 1}), wo = normalize({-0.1, 0.05, 1});
  for (const double u : {0.1, 0.33, 0.71})
    EXPECT_EQ(lit(widened, u, 0.4, 0, wi, wo), lit(surface, u, 0.4, 0, wi, wo));
  EXPECT_EQ(widened.weight_bytes(), surface.weight_bytes());
  EXPECT_EQ(widened.own_model(), surface.lobes());
  // a lobe's weight is what it and its copies have together
  for (const double lod : {1.0, 3.0, 5.0}) {
    double sum = static_cast<double>(widened.weight(0, 0.3, 0.6, lod)[0]);
    for (std::size_t j = 2; j < widened.lobes().lobes().size(); ++j)
      sum += static_cast<double>(widened.weight(j, 0.3, 0.6, lod)[0]);
    EXPECT_NEAR(sum, static_cast<double>(surface.weight(0, 0.3, 0.6, lod)[0]), 5.0 / 255);
    EXPECT_EQ(widened.weight(1, 0.3, 0.6, lod), surface.weight(1, 0.3, 0.6, lod));
  }
}

TEST(WidenedLobes, AreNotMadeWithoutBumps) {
  const SpatialBrdf surface = bumpy();
  SurfaceMaps maps = surface.maps();
  maps.normals.reset();
  EXPECT_TRUE(with_widened_lobes(SpatialBrdf(surface.lobes(), maps)).widened().empty());
  const std::vector<float> level(2 * kSide * kSide, 0.1f);
  maps.normals = SurfaceMap(kSide, kSide, 2, TableFormat::half, 1, level);
  EXPECT_TRUE(with_widened_lobes(SpatialBrdf(surface.lobes(), maps)).widened().empty());
  const SpatialBrdf widened = with_widened_lobes(surface);
  EXPECT_EQ(with_widened_lobes(widened), widened);
}

TEST(WidenedLobes, AreRestoredByTheirFile) {
  const SurfaceModel surface{.brdf = with_widened_lobes(bumpy()), .notes = "{}"};
  const std::string bytes = format_surface(surface);
  EXPECT_EQ(parse_surface(memory_file(bytes)), surface);
  EXPECT_EQ(parse_surface(memory_file(format_surface_exr(surface))), surface);
  for (std::size_t length = 0; length < bytes.size(); length += 97)
    EXPECT_THROW(parse_surface(memory_file(bytes.substr(0, length))), Error) << length;
}

TEST(WidenedLobes, HaveToFit) {
  const SpatialBrdf widened = with_widened_lobes(bumpy());
  SurfaceMaps own = bumpy().maps();
  std::vector<WidenedLobe> copies(widened.widened().begin(), widened.widened().end());
  EXPECT_EQ(SpatialBrdf(widened.lobes(), own, copies), widened);
  const auto with = [&](auto change) {
    SurfaceMaps maps = own;
    std::vector<WidenedLobe> changed = copies;
    change(maps, changed);
    return SpatialBrdf(widened.lobes(), maps, changed);
  };
  EXPECT_THROW(with([](SurfaceMaps& m, auto&) { m.normals.reset(); }), Error);
  EXPECT_THROW(with([](SurfaceMaps&, auto& c) { c.back().lobe = 2; }), Error);
  EXPECT_THROW(with([](SurfaceMaps&, auto& c) { c.front().variance = 0; }), Error);
  EXPECT_THROW(with([](SurfaceMaps&, auto& c) { c.front().variance = std::nan(""); }), Error);
  EXPECT_THROW(with([](SurfaceMaps&, auto& c) { c.pop_back(); }), Error);
}

}  // namespace
}  // namespace burnish
