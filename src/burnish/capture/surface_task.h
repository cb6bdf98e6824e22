// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <burnish/capture/surface_fit.h>

namespace burnish {

/// The task of a fit, as all of its steps see it: options in range, and the values that the options left to the
/// capture. Nothing in it changes while the fit runs.
struct SurfaceTask {
  const SurfaceFitOptions& options;
  NormalsFrom normals;               ///< from the options, or else what suits the capture
  int rounds;                        ///< each finds lobes, then weights
  std::vector<float> known_normals;  ///< [row][x][2] of all texels; empty unless `normals` is of the capture
  std::uint64_t key;  ///< a hash of the capture as opened and of all that changes the result; even

  int ranks() const noexcept { return options.crew ? options.crew->ranks() : 1; }
  int rank() const noexcept { return options.crew ? options.crew->rank() : 0; }
  /// True if this process writes checkpoints.
  bool notes_progress() const noexcept { return !options.checkpoint.empty() && rank() == 0; }
  /// Reports progress, at the leading rank only.
  void progress(std::string_view stage, double fraction) const {
    if (options.progress && rank() == 0) options.progress(stage, fraction);
  }
};

/// Returns the task that options set for a capture that was just opened. The options must outlive the task. Throws
/// Error for options out of range, for normals that the capture does not have, and as Capture::normals does.
SurfaceTask task_of(const Capture& capture, const SurfaceFitOptions& options);

}  // namespace burnish
