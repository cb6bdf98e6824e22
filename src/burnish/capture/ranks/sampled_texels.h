#pragma once

#include <cstdint>
#include <functional>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/ranks/fit_crew.h>
#include <burnish/capture/texels/texel_solver.h>

namespace burnish {

/// Texels spread evenly over a capture's surface, one at random in each cell of a grid, as many as hold about so many
/// values in all pictures. Reads every picture once, tile by tile, and leaves out those that turn out damaged. Ranks of
/// a crew, all of which call this, read tiles in turn, and every picture again, each of them, where one is damaged.
struct SampledTexels {
  TexelSamples samples;
  std::size_t missing = 0, clipped = 0;  ///< pixels of all texels in pictures that are fitted
};
SampledTexels sample_texels(Capture& capture, std::size_t most_values, std::size_t tile_bytes,
                            std::uint64_t seed, const std::function<void(double)>& progress,
                            FitCrew* crew = nullptr);

}  // namespace burnish
