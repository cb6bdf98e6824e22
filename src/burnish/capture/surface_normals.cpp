// SPDX-License-Identifier: Apache-2.0
#include <burnish/capture/ranks/shared_work.h>
#include <burnish/capture/surface_normals.h>
#include <burnish/capture/texels/texel_starts.h>
#include <burnish/surface/surface_map.h>

namespace burnish {

std::vector<float> first_normals(const TexelSamples& samples, const CaptureForm& form, double exposure,
                                 FitCrew* crew) {
  constexpr int kSteps = 4;
  const TexelSolver solver(general_lobes(), form, exposure);
  return solve_together(crew, solver, samples, diffuse_normals(samples, form),
                        {.passes = 1, .normals = true, .normal_steps = kSteps})
      .normals;
}

std::vector<float> normals_at(const std::vector<std::array<int, 2>>& texels, const std::vector<float>& all,
                              int width) {
  std::vector<float> normals;
  if (all.empty()) return normals;
  for (const auto& [x, y] : texels) {
    const std::size_t at =
        2 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    normals.insert(normals.end(), {all[at], all[at + 1]});
  }
  return normals;
}

std::vector<float> every_normal(const std::vector<float>& all, std::size_t step) {
  std::vector<float> some;
  for (std::size_t i = 0; i < all.size(); i += 2 * step) some.insert(some.end(), {all[i], all[i + 1]});
  return some;
}

std::vector<float> rounded_normals(const std::vector<float>& normals, int width) {
  const int rows = static_cast<int>(normals.size() / 2) / width;
  const SurfaceMap map(width, rows, 2, TableFormat::half, 1, normals);
  std::vector<float> rounded;
  rounded.reserve(normals.size());
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < width; ++x) {
      const SurfaceMap::Value n = map.texel(x, y);
      rounded.insert(rounded.end(), {n[0], n[1]});
    }
  return rounded;
}

}  // namespace burnish
