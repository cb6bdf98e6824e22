// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/ranks/fit_crew.h>
#include <burnish/capture/texels/texel_solver.h>

namespace burnish {

// Normals of texels are x and y of unit vectors, [texel][2]; an empty list says that all are flat.

/// Returns normals before lobes are known: first as if texels were diffuse, then by a fit of general lobes. The ranks
/// of a crew share the texels; null: this process alone.
std::vector<float> first_normals(const TexelSamples& samples, const CaptureForm& form, double exposure,
                                 FitCrew* crew);

/// Picks the normals of some texels from the normals of all, [row][x][2] of rows of `width`. Empty if `all` is empty.
std::vector<float> normals_at(const std::vector<std::array<int, 2>>& texels, const std::vector<float>& all,
                              int width);

/// Picks the normal of every step-th texel from the first on, as every() picks texels.
std::vector<float> every_normal(const std::vector<float>& all, std::size_t step);

/// Rounds normals to the halves that a surface's map stores; they are whole rows of `width`.
std::vector<float> rounded_normals(const std::vector<float>& normals, int width);

}  // namespace burnish
