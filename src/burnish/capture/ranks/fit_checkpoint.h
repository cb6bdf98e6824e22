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

/// How far the fit of a surface is: its lobes, and the rows whose weights are found.
struct FitCheckpoint {
  std::uint64_t key = 0;  ///< of the capture and the options; what has another is not gone on from
  std::vector<Capture::LeftOut> damaged;  ///< pictures that turned out so since the capture was opened
  std::uint64_t missing_pixels = 0, clipped_pixels = 0;
  double exposure = 1;
  FactoredBrdf lobes;
  std::vector<float> scales;                  ///< of the lobes' codes
  int rows = 0;                               ///< that are done, from the first on
  std::vector<std::vector<std::byte>> codes;  ///< [lobe][row][x] of these
  std::vector<float> normals;                 ///< [row][x][2] of these, or none
  std::uint64_t texels_without_data = 0;      ///< of these
  std::vector<TexelSolver::PictureError> errors;
};

/// The same before the lobes are found: after a round of them, all that the next round goes on from.
struct LobesCheckpoint {
  std::uint64_t key = 0;
  int rounds = 0;                               ///< that are done
  std::vector<std::vector<double>> log_values;  ///< of LogModel
  TexelFits fits;                               ///< of the texels that the round was fitted to, without costs
  std::vector<float> normals_of_all;  ///< where that was a part of the texels: what all begin with, or none
};

/// One CBOR item; it is read by the program that wrote it.
std::string format_checkpoint(const FitCheckpoint& checkpoint);
std::string format_checkpoint(const LobesCheckpoint& checkpoint);
/// Throws Error, naming the offset, for other bytes, and where a number of rows of `width` texels contradicts what
/// is there.
FitCheckpoint parse_checkpoint(const FileBytes& file, int width);
/// Nothing where the file is no checkpoint of lobes. Throws Error, naming the offset, where one is damaged.
std::optional<LobesCheckpoint> parse_lobes_checkpoint(const FileBytes& file);

}  // namespace burnish
