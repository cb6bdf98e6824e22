// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/texels/texel_solver.h>
#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// Returns 1 / the 97th percentile of the fitted pixels; 1 if that is 0.
double exposure_of(const TexelSamples& samples, const CaptureForm& form);

/// Returns x and y of texels' normals as if they were diffuse, [texel][2]. The method is photometric stereo
/// [Woodham1980] on the mean of the channels. It minimizes the sum of absolute errors, on which highlights and
/// shadows have little influence. Normals stay within 60 degrees of the surface's.
std::vector<float> diffuse_normals(const TexelSamples& samples, const CaptureForm& form);

/// Returns K sets of texels, each of which looks like one material. Texels are described by the weights of general
/// lobes (a diffuse one and glossy ones of several widths, in each channel), and grouped by them. The groups that no
/// mixture of other groups resembles come first. Every set has at least one texel. The result is deterministic.
std::vector<std::vector<std::size_t>> pure_texels(const TexelSamples& samples, const CaptureForm& form,
                                                  const std::vector<float>& normals, double exposure,
                                                  std::size_t count);

/// Returns the general lobes that describe texels: three channels, each lobe in one channel alone.
FactoredBrdf general_lobes();

}  // namespace burnish
