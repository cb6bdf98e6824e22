#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <burnish/capture/surface_fit.h>

namespace burnish {

/// What a fit was asked, as all of its steps see it: options that are in range, and what they left to the capture.
/// Nothing in it changes while the fit runs.
struct SurfaceTask {
  const SurfaceFitOptions& options;
  NormalsFrom normals;               ///< what the options say, or what suits the capture
  int rounds;                        ///< of lobes and weights in turn
  std::vector<float> known_normals;  ///< of all texels, [row][x][2]; empty unless `normals` is of the capture
  std::uint64_t key;  ///< of the capture as it was opened and of all that changes the result; even

  int ranks() const noexcept { return options.crew ? options.crew->ranks() : 1; }
  int rank() const noexcept { return options.crew ? options.crew->rank() : 0; }
  /// Whether this process writes checkpoints.
  bool notes_progress() const noexcept { return !options.checkpoint.empty() && rank() == 0; }
  /// Passes on what is done, at the rank that leads.
  void progress(std::string_view stage, double fraction) const {
    if (options.progress && rank() == 0) options.progress(stage, fraction);
  }
};

/// The task that options are of a capture that was just opened; the options must outlive it. Throws Error for options
/// out of range, normals that the capture has not, and as Capture::normals does.
SurfaceTask task_of(const Capture& capture, const SurfaceFitOptions& options);

}  // namespace burnish
