// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/capture/surface_fit.h>

namespace burnish {

/// The score of one method that could stand in for lobes whose scales are maps.
struct BaselineScore {
  std::string method;
  double bytes_a_texel = 0;        ///< stored bytes, without normals
  std::optional<double> held_out;  ///< PSNR of the held-out pictures at the texels that are compared
};

/// Scores a fit and other methods in its place. All use its normals and exposure, and the same texels, some thousands
/// spread over the surface:
/// - "lobes": the fit itself;
/// - "ggx": in each texel a diffuse lobe and a glossy lobe of GGX [Walter2007], both coloured. The glossy one has
///   Smith's shadowing, separable in the two directions, and Schlick's Fresnel term of a dielectric. Its roughness is
///   the one of 16 that fits best. Tools of photogrammetry give this. 7 bytes;
/// - "nearest": in each texel the one lobe of the fit that fits best, without mixing. 1 byte tells the lobe, 1 its
///   weight;
/// - "pca": principal components of the logarithms of texels in the fitted pictures, as many as the fit has bytes a
///   texel. A held-out picture is the mean of the three fitted pictures whose light and view are nearest, weighted by
///   the inverse square of their distance. The components themselves are not counted.
/// The baselines' numbers are not rounded to their bytes. Throws what Capture throws.
std::vector<BaselineScore> score_surface_baselines(Capture capture, const SurfaceFit& fit,
                                                   const SurfaceFitOptions& options);

}  // namespace burnish
