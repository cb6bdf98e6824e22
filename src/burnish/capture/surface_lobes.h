#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/capture/surface_task.h>
#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// The lobes of a surface, and what was found on the way to them that the weights of all texels need.
struct SurfaceLobes {
  FactoredBrdf lobes;
  std::vector<float> scales;  ///< of the codes of each lobe's weights, > 0
  double exposure = 1;        ///< what makes the 97th percentile of fitted pixels white
  std::size_t missing_pixels = 0, clipped_pixels = 0;  ///< of the pictures that are fitted
};

/// Reads a sample of the texels and fits lobes to it, or weights of the book's lobes where the task has one. Goes on
/// from `begun`, the end of a round of the same task, where there is one. Leaves pictures out of the capture that turn
/// out damaged. The rank that leads writes the task's checkpoint after each round but the last; all ranks of the crew
/// call this and return the same. Throws Error where `begun` is of other lobes or texels, where no pixel can be fitted,
/// and as Capture::read and Capture::leave_out do.
SurfaceLobes find_lobes(Capture& capture, const SurfaceTask& task, std::optional<LobesCheckpoint> begun);

}  // namespace burnish
