#pragma once

#include <cstddef>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/texels/texel_solver.h>
#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// 1 / the 97th percentile of the pixels that are fitted; 1 where that is 0.
double exposure_of(const TexelSamples& samples, const CaptureForm& form);

/// x and y of texels' normals as if they were diffuse, [texel][2]: photometric stereo [Woodham1980] on the mean of the
/// channels, with the least sum of absolute errors, which highlights and shadows lead little. Normals stay within 60
/// degrees of the surface's.
std::vector<float> diffuse_normals(const TexelSamples& samples, const CaptureForm& form);

/// K sets of texels of which each looks like one material: texels grouped by what general lobes (a diffuse one and
/// glossy ones of several widths, in each channel) make of them, the groups that no mixture of others resembles first.
/// Every set has at least one texel. Deterministic.
std::vector<std::vector<std::size_t>> pure_texels(const TexelSamples& samples, const CaptureForm& form,
                                                  const std::vector<float>& normals, double exposure,
                                                  std::size_t count);

/// The general lobes that texels are described by, three channels, each in one channel alone.
FactoredBrdf general_lobes();

}  // namespace burnish
