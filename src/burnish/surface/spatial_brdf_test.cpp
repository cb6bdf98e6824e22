// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/metrics/albedo.h>
#include <burnish/surface/spatial_brdf.h>
#include <burnish/testing/surfaces.h>

namespace burnish {
namespace {

using Values = std::array<double, 3>;

Values value(const SpatialBrdf& surface, double u, double v, double lod, Vec3 wi, Vec3 wo) {
  Values f;
  surface.eval(u, v, lod, wi, wo, f);
  return f;
}

const Vec3 kLight = normalize({0.3, -0.2, 0.8}), kView = normalize({-0.5, 0.1, 0.7});

// A texel is the uniform model of its weights in its frame.
TEST(SpatialBrdf, IsAUniformModelAtEveryPlace) {
  const SpatialBrdf surface = random_surface(6, 5);
  for (const double lod : {0.0, 0.7, 2.0})
    for (const double u : {0.08, 0.5, 0.93}) {
      const ShadingFrame frame = surface.frame(u, 0.3, lod);
      EXPECT_NEAR(dot(frame.tangent, frame.normal), 0, 1e-12);
      EXPECT_NEAR(length(frame.bitangent), 1, 1e-12);
      Values expected;
      surface.at(u, 0.3, lod).eval(frame.local(kLight), frame.local(kView), expected);
      const Values found = value(surface, u, 0.3, lod, kLight, kView);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-6 * expected[c]);
    }
}

TEST(SpatialBrdf, IsReciprocalToTheLastBit) {
  const SpatialBrdf surface = random_surface(6, 5);
  for (const double u : {0.1, 0.4, 0.8})
    EXPECT_EQ(value(surface, u, 0.6, 0.3, kLight, kView), value(surface, u, 0.6, 0.3, kView, kLight));
}

// Mip levels are linear in what they mean: a level's value is the mean of what it covers, to rounding of the weights.
TEST(SpatialBrdf, LevelsAreTheMeansOfTheirTexels) {
  const FactoredBrdf lobes = random_surface(4, 4).lobes();
  SurfaceMaps maps;
  for (std::uint64_t j = 0; j < 3; ++j) maps.weights.push_back(random_map(8, 8, 1, TableFormat::half, 1, j));
  const SpatialBrdf surface(lobes, std::move(maps));
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      Values mean{};
      for (int k = 0; k < 4; ++k) {
        const Values f =
            value(surface, (2 * x + k % 2 + 0.5) / 8, (2 * y + k / 2 + 0.5) / 8, 0, kLight, kView);
        for (std::size_t c = 0; c < 3; ++c) mean[c] += f[c] / 4;
      }
      const Values f = value(surface, (x + 0.5) / 4, (y + 0.5) / 4, 1, kLight, kView);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], mean[c], 0x1p-10 * mean[c]);
    }
}

TEST(SpatialBrdf, IsBlackBelowTheShadingHorizon) {
  const FactoredBrdf lobes = random_model("q(theta_h)", {"q=4"}, 3, TableFormat::half);
  const std::array<float, 2> tilted{0.9f, 0};
  const SpatialBrdf surface(lobes, {.weights = {SurfaceMap(1, 1, 1, TableFormat::half, 1, std::array{1.0f})},
                                    .normals = SurfaceMap(1, 1, 2, TableFormat::half, 1, tilted),
                                    .tangents = {}});
  EXPECT_EQ(value(surface, 0.5, 0.5, 0, normalize({-0.9, 0, 0.2}), kView)[0], 0);
  EXPECT_GT(value(surface, 0.5, 0.5, 0, normalize({0.5, 0, 0.5}), normalize({0.3, 0.1, 0.9}))[0], 0);
}

TEST(SpatialBrdf, CountsItsBytes) {
  const SpatialBrdf surface = random_surface(6, 5);
  EXPECT_EQ(surface.weight_bytes(), 1u + 3 + 2);
  EXPECT_EQ(surface.frame_bytes(), 4u + 4);
  EXPECT_EQ(surface.bytes(), 30 * 14 + surface.lobes().bytes());
}

TEST(SpatialBrdf, RefusesMapsThatDoNotFit) {
  const SpatialBrdf good = random_surface(6, 5);
  const auto with = [&](auto change) {
    SurfaceMaps maps = good.maps();
    change(maps);
    return SpatialBrdf(good.lobes(), std::move(maps));
  };
  EXPECT_NO_THROW(with([](SurfaceMaps&) {}));
  EXPECT_THROW(with([](SurfaceMaps& m) { m.weights.pop_back(); }), Error);
  EXPECT_THROW(with([](SurfaceMaps& m) { m.weights[1] = random_map(5, 6, 1, TableFormat::half, 1, 1); }),
               Error);
  EXPECT_THROW(with([](SurfaceMaps& m) { m.weights[1] = random_map(6, 5, 2, TableFormat::half, 1, 1); }),
               Error);
  EXPECT_THROW(with([](SurfaceMaps& m) { m.weights[0] = random_vectors(6, 5, 0.5, 1, 1); }), Error);
  EXPECT_THROW(with([](SurfaceMaps& m) { m.normals = random_vectors(6, 5, 1.1, 1.2, 1); }), Error);
  EXPECT_THROW(with([](SurfaceMaps& m) { m.tangents = random_vectors(6, 5, 0, 0.1, 1); }), Error);
  const SurfaceMap negative(6, 5, 1, TableFormat::half, 1, std::vector<float>(30, -1));
  EXPECT_THROW(with([&](SurfaceMaps& m) { m.weights[2] = negative; }), Error);
}

// The linear sum is what integrating a texel's own model gives.
TEST(SurfaceAlbedo, IsThatOfTheTexelsModel) {
  const SpatialBrdf surface = random_surface(3, 2);
  const SurfaceAlbedo found = surface_albedo(surface);
  const double u = (found.x + 0.5) / 3, v = (found.y + 0.5) / 2;
  double largest = 0;
  for (const AlbedoAt& at : albedo_curve(surface.at(u, v), std::array{found.theta_i}))
    for (const double albedo : at.albedo.albedo) largest = std::max(largest, albedo);
  EXPECT_NEAR(found.largest, largest, 4 * kAlbedoTolerance * largest);
  EXPECT_GT(found.mean, 0);
  EXPECT_LE(found.mean, found.largest);
  EXPECT_EQ(found.above_one > 0, found.largest > 1);
}

}  // namespace
}  // namespace burnish
