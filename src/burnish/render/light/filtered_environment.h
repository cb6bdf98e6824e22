// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/render/light/environment_light.h>

namespace burnish {

/// The resolution of a blurred environment.
struct BlurOptions {
  int side = 64;             ///< texels along a hemisphere's map, in [8, 512]
  int levels = 12;           ///< in [2, 32]
  double narrowest = 0.02;   ///< width of level 0, radians, in [1e-3, 0.5]
  double step = 1.41421356;  ///< from one level's width to the next, in [1.1, 4]
};

/// exp((cosine - 1) / width^2) over its integral over the sphere, 1/sr.
double blur_weight(double cosine, double width) noexcept;

/// An environment blurred by blur_weight to widths that rise by a constant factor.
/// Serves every material.
struct BlurredEnvironment {
  BlurOptions options;
  /// Pairs of parabolic maps, as PrefilteredLobe has them, RGB: [level][y][x].
  std::vector<float> maps;

  std::size_t bytes() const noexcept { return maps.size() / 3 * 8; }
  /// Light about the unit vector w blurred to `width` (radians), linear in its logarithm between levels.
  Rgb radiance(Vec3 w, double width) const noexcept;
};

/// Sums over the texels of the sky and over points of the discs. Throws Error for options out of range.
BlurredEnvironment blur(const Environment& environment, const BlurOptions& options = {});

}  // namespace burnish
