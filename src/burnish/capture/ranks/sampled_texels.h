// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/ranks/fit_crew.h>
#include <burnish/capture/texels/texel_solver.h>

namespace burnish {

/// Samples texels that are spread evenly over a capture's surface: one at random in each cell of a grid. Their number
/// is such that all pictures together have about `most_values` values of them. Every picture is read once, tile by
/// tile; pictures that turn out damaged are left out. All ranks of a crew call this and read tiles in turn. If a
/// picture is damaged, each rank reads every picture again.
struct SampledTexels {
  TexelSamples samples;
  std::size_t missing = 0, clipped = 0;  ///< pixels of all texels in pictures that are fitted
};
SampledTexels sample_texels(Capture& capture, std::size_t most_values, std::size_t tile_bytes,
                            std::uint64_t seed, const std::function<void(double)>& progress,
                            FitCrew* crew = nullptr);

}  // namespace burnish
