// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/texels/texel_solver.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// The trust in pixels when lobes are fitted to them.
enum class PixelTrust {
  alike,    ///< all pixels count alike: TexelFits::trust is not read
  mild,     ///< TexelFits::trust, but only large errors count against a pixel
  as_found  ///< TexelFits::trust as it is
};

/// Texels whose pixels lobes are fitted to, and the values known for them so far.
struct KnownTexels {
  const TexelSamples& samples;
  const CaptureForm& form;
  double exposure;
  /// Normals, or none if all are flat; weights if `lobes` is given; trust if `trust` needs it.
  const TexelFits& fits;
  const FactoredBrdf* lobes;  ///< lobes that the weights belong to; null if no lobe is known yet
  PixelTrust trust;
};

/// Draws pixels of some of the texels at random. Each bin of theta_h gives as many as it has, up to an even part;
/// together they are `count` if there are enough. Half of them, the set's pictures, are weighted so that they
/// represent all pixels. The other half, its pairs, count evenly over theta_h. A clipped value is a lower bound: it
/// is replaced by the lobes' value if that is larger. `texels` is in rising order and not empty. The same seed and
/// stream draw the same pixels. Throws Error if no pixel can be fitted.
TrainingSet training_pixels(const KnownTexels& known, std::span<const std::size_t> texels, std::size_t count,
                            std::uint64_t seed, std::uint64_t stream);

}  // namespace burnish
