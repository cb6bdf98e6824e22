// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/texels/texel_solver.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/file.h>

namespace burnish {

/// The state of a surface's fit: its lobes, and the rows whose weights are found.
struct FitCheckpoint {
  std::uint64_t key = 0;  ///< hash of capture and options; a checkpoint with another key is not resumed
  std::vector<Capture::LeftOut> damaged;  ///< pictures found damaged since the capture was opened
  std::uint64_t missing_pixels = 0, clipped_pixels = 0;
  double exposure = 1;
  FactoredBrdf lobes;
  std::vector<float> scales;                  ///< scales of the lobes' codes
  int rows = 0;                               ///< the number of finished rows, from the first on
  std::vector<std::vector<std::byte>> codes;  ///< [lobe][row][x] of these rows
  std::vector<float> normals;                 ///< [row][x][2] of these rows, or none
  std::uint64_t texels_without_data = 0;      ///< in these rows
  std::vector<TexelSolver::PictureError> errors;
};

/// The state before the lobes are final: all that the next round of lobes needs after a finished round.
struct LobesCheckpoint {
  std::uint64_t key = 0;
  int rounds = 0;                               ///< the number of finished rounds
  std::vector<std::vector<double>> log_values;  ///< the tables of LogModel
  TexelFits fits;                               ///< fits of the last round's texels, without costs
  /// The normals that all texels begin with, if the last round was fitted to a part of them; otherwise none.
  std::vector<float> normals_of_all;
};

/// Returns one CBOR item. The same version of the program reads it back.
std::string format_checkpoint(const FitCheckpoint& checkpoint);
std::string format_checkpoint(const LobesCheckpoint& checkpoint);
/// Throws Error with the offset if the bytes are no checkpoint, or if the number of rows of `width` texels
/// contradicts the data.
FitCheckpoint parse_checkpoint(const FileBytes& file, int width);
/// Returns nothing if the file is no checkpoint of lobes. Throws Error with the offset if one is damaged.
std::optional<LobesCheckpoint> parse_lobes_checkpoint(const FileBytes& file);

}  // namespace burnish
