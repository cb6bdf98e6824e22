// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/capture/surface_task.h>
#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// The lobes of a surface, and the values found with them that the weights of all texels need.
struct SurfaceLobes {
  FactoredBrdf lobes;
  std::vector<float> scales;  ///< the scale of each lobe's weight codes, > 0
  double exposure = 1;        ///< makes the 97th percentile of the fitted pixels white
  std::size_t missing_pixels = 0, clipped_pixels = 0;  ///< in the fitted pictures
};

/// Reads a sample of the texels and fits lobes to it, or only weights if the task has a book of lobes. Resumes from
/// `begun`, the end of a round of the same task, if it is given. Pictures that turn out damaged are left out of the
/// capture. The leading rank writes the task's checkpoint after each round but the last. All ranks of the crew call
/// this function and return the same result. Throws Error if `begun` has other lobes or texels, if no pixel can be
/// fitted, and as Capture::read and Capture::leave_out do.
SurfaceLobes find_lobes(Capture& capture, const SurfaceTask& task, std::optional<LobesCheckpoint> begun);

}  // namespace burnish
