// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/capture/surface_task.h>

namespace burnish {

/// The result of find_weights.
struct SurfaceWeights {
  FitCheckpoint done;  ///< with all rows; at ranks other than the leading one, only their number
  double seconds = 0;  ///< on weights and normals at this rank, without reading and scoring
};

/// Finds the weights of the rows that `begun` lacks, and normals if the task estimates them. Rounds them to what is
/// stored, and scores the rounded values. `begun` has lobes, scales, exposure, and rows from the first on, none to
/// all.
///
/// In each turn every rank finds one tile. The leading rank joins the tiles in their order, and writes the task's
/// checkpoint now and then. The result has the same bits for any tiles and ranks. Throws Error as Capture::read, and
/// if a picture is damaged that was sound when it was first read.
SurfaceWeights find_weights(const Capture& capture, const SurfaceTask& task, FitCheckpoint begun);

/// Returns the mean errors of the held-out pictures, or of the fitted ones.
PictureScore score_of(const std::vector<TexelSolver::PictureError>& errors, const CaptureForm& form,
                      bool held_out);

}  // namespace burnish
