// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/math/vec3.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Some texels in every picture of a capture.
struct TexelSamples {
  std::vector<std::array<int, 2>> texels;  ///< x, y
  std::size_t pictures = 0;
  std::vector<float> values;       ///< f cos(theta_i), [picture][texel][channel], three channels
  std::vector<PixelState> states;  ///< [picture][texel]
  /// Unit vectors towards light and view, [picture][texel][6]; empty: the form's stations tell them.
  std::vector<float> directions = {};

  std::size_t size() const noexcept { return texels.size(); }
  /// Unit vectors towards light and view from texel t, whose middle is `point`.
  DirectionPair seen(const CapturePicture& picture, std::size_t p, std::size_t t, Vec3 point) const noexcept {
    if (directions.empty()) return {picture.light.seen_from(point), picture.view.seen_from(point)};
    const float* const w = &directions[6 * (p * size() + t)];
    return {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
  }
};

/// Returns the samples of all texels of some rows.
TexelSamples samples_of(CaptureRows rows);
/// Returns every step-th texel from the first on.
TexelSamples every(const TexelSamples& all, std::size_t step);

}  // namespace burnish
