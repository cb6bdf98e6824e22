#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/ranks/fit_crew.h>
#include <burnish/capture/texels/texel_solver.h>

namespace burnish {

// Normals of texels are x and y of unit vectors, [texel][2]; an empty list says that all are flat.

/// Normals before lobes are known: as if texels were diffuse, then by what general lobes make of them. Ranks of a crew
/// share the texels; null: this process has them all.
std::vector<float> first_normals(const TexelSamples& samples, const CaptureForm& form, double exposure,
                                 FitCrew* crew);

/// Those of some texels out of those of all, [row][x][2] of rows of `width`; empty where these are.
std::vector<float> normals_at(const std::vector<std::array<int, 2>>& texels, const std::vector<float>& all,
                              int width);

/// Those of every step-th texel from the first on, as every() takes texels.
std::vector<float> every_normal(const std::vector<float>& all, std::size_t step);

/// As a surface's map stores them: in halves, whole rows of `width`.
std::vector<float> rounded_normals(const std::vector<float>& normals, int width);

}  // namespace burnish
