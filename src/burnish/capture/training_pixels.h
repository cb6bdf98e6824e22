#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/texels/texel_solver.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// How far pixels are trusted when lobes are fitted to them.
enum class PixelTrust {
  alike,    ///< all alike: TexelFits::trust is not read
  mild,     ///< as found, but only large errors count against a pixel
  as_found  ///< as TexelFits::trust says
};

/// Texels whose pixels lobes are fitted to, and what is known of them so far.
struct KnownTexels {
  const TexelSamples& samples;
  const CaptureForm& form;
  double exposure;
  /// Normals, or none where all are flat; weights where `lobes` are known; trust where `trust` reads it.
  const TexelFits& fits;
  const FactoredBrdf* lobes;  ///< what the weights are of; null where no lobe is known yet
  PixelTrust trust;
};

/// Pixels of some of the texels, drawn at random: as many of each theta_h as there are, up to an even part, together
/// `count` where there are enough. Half of them, the set's pictures, are weighted as all pixels; the others, its pairs,
/// evenly over theta_h. A clipped value stands for what the lobes make of it, where that is more: it is a lower bound.
/// `texels` is in rising order and not empty; the same seed and stream draw the same pixels. Throws Error where no pixel
/// can be fitted.
TrainingSet training_pixels(const KnownTexels& known, std::span<const std::size_t> texels, std::size_t count,
                            std::uint64_t seed, std::uint64_t stream);

}  // namespace burnish
