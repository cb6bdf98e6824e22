#pragma once

#include <string>
#include <vector>

#include <burnish/capture/surface_fit.h>

namespace burnish {

/// What others would do with a capture instead of lobes whose scales are maps.
struct BaselineScore {
  std::string method;
  double bytes_a_texel = 0;        ///< as stored, normals apart
  std::optional<double> held_out;  ///< PSNR of pictures that were held out, of the texels that were looked at
};

/// A fit and others in its place, all with its normals and exposure, scored at the same texels, some thousands spread
/// over the surface:
/// - "lobes": the fit itself;
/// - "ggx": in each texel a diffuse and a glossy lobe of GGX [Walter2007] with Smith's shadowing, separable in the two
///   directions, and Schlick's Fresnel term of a dielectric, both coloured, the roughness that serves best of 16:
///   what tools of photogrammetry give. 7 bytes;
/// - "nearest": in each texel the one of the fit's lobes that serves best, without mixing: 1 byte which, 1 how much;
/// - "pca": principal components of the logarithms of texels in the fitted pictures, as many as the fit has bytes a
///   texel; a held-out picture is the mean of the three fitted ones whose light and view are nearest, by the inverse
///   square of how far they are. The components themselves are not counted.
/// Numbers of the baselines are not rounded to their bytes. Throws what Capture throws.
std::vector<BaselineScore> score_surface_baselines(Capture capture, const SurfaceFit& fit,
                                                   const SurfaceFitOptions& options);

}  // namespace burnish
