#pragma once

#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/capture/surface_task.h>

namespace burnish {

/// What find_weights returns.
struct SurfaceWeights {
  FitCheckpoint done;  ///< with all rows; only their number at ranks that do not lead
  double seconds = 0;  ///< of these in weights and normals, without reading and scoring; of this rank
};

/// Finds the weights of the rows that `begun` has not, and normals where the task estimates them, rounds them to what
/// is stored, and scores what was rounded. `begun` has lobes, scales, exposure, and rows from the first on, none to all.
/// A turn is a tile a rank, which the rank that leads puts together in their order; it writes the task's checkpoint now
/// and then. The same bits for any tiles and ranks. Throws Error as Capture::read, and where a picture is
/// damaged that was sound when it was read first.
SurfaceWeights find_weights(const Capture& capture, const SurfaceTask& task, FitCheckpoint begun);

/// The means of errors of the pictures that are held out, or of those that are not.
PictureScore score_of(const std::vector<TexelSolver::PictureError>& errors, const CaptureForm& form,
                      bool held_out);

}  // namespace burnish
