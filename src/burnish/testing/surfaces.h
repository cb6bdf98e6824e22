// SPDX-License-Identifier: Apache-2.0
#pragma once

// Small surfaces for tests.

#include <cmath>
#include <string>
#include <vector>

#include <burnish/math/random.h>
#include <burnish/surface/surface_file.h>
#include <burnish/testing/models.h>

namespace burnish {

/// Returns random weights in [0, scale], every fourth 0.
inline SurfaceMap random_map(int width, int height, std::size_t channels, TableFormat format, float scale,
                             std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<float> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels);
  for (float& value : values)
    value = random.next() % 4 == 0 ? 0.0f : static_cast<float>(scale * random.uniform());
  return {width, height, channels, format, scale, values};
}

/// Returns x and y of random vectors, no longer than `longest` and no shorter than `shortest`.
inline SurfaceMap random_vectors(int width, int height, double shortest, double longest, std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<float> values;
  for (int i = 0; i < width * height; ++i) {
    const double length = shortest + (longest - shortest) * random.uniform(),
                 angle = 6.2831853 * random.uniform();
    values.push_back(static_cast<float>(length * std::cos(angle)));
    values.push_back(static_cast<float>(length * std::sin(angle)));
  }
  return {width, height, 2, TableFormat::half, 1, values};
}

/// Returns three lobes, of volumes, lines and a hemisphere. Weights are grey and coloured, in both formats; normals
/// and tangents are random.
inline SpatialBrdf random_surface(int width, int height) {
  FactoredBrdf lobes =
      random_model("z(theta_h) g(theta_h,theta_d,phi_d) + p(wo) q(h) p(wi) + r(theta_d)",
                   {"z=12,power:0.5", "g=5x4x3,power:0.5", "p=6", "q=7x7", "r=5"}, 3, TableFormat::half);
  return {std::move(lobes),
          {.weights = {random_map(width, height, 1, TableFormat::unorm8, 1.7f, 1),
                       random_map(width, height, 3, TableFormat::unorm8, 0.4f, 2),
                       random_map(width, height, 1, TableFormat::half, 3.0f, 3)},
           .normals = random_vectors(width, height, 0, 0.6, 4),
           .tangents = random_vectors(width, height, 1, 1, 5)}};
}

/// Returns two smooth lobes whose weights and normals run in waves over `side` by `side` texels.
inline SpatialBrdf smooth_surface(int side) {
  std::vector<float> first, second, normals;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double u = 6.2831853 * (x + 0.5) / side, v = 6.2831853 * (y + 0.5) / side;
      first.push_back(static_cast<float>(0.5 + 0.5 * std::sin(3 * u) * std::cos(2 * v)));
      second.push_back(static_cast<float>(0.5 + 0.5 * std::cos(5 * u + v)));
      normals.push_back(static_cast<float>(0.2 * std::sin(2 * u)));
      normals.push_back(static_cast<float>(0.2 * std::cos(3 * v)));
    }
  return {smooth_model(model_case("Volumes")),
          {.weights = {SurfaceMap(side, side, 1, TableFormat::unorm8, 1, first),
                       SurfaceMap(side, side, 1, TableFormat::unorm8, 1, second)},
           .normals = SurfaceMap(side, side, 2, TableFormat::half, 1, normals),
           .tangents = {}}};
}

}  // namespace burnish
