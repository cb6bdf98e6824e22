#pragma once

#include <optional>
#include <string>

#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/file.h>

namespace burnish {

/// The steps of a surface's fit that all ranks take.
enum class FitStep { lobes, weights };

/// What rank 0 tells the others first: the step to begin with. The checkpoint of rows, with the lobes, comes before the
/// weights either way, as a message of its own.
struct FitStart {
  FitStep step = FitStep::lobes;
  std::optional<LobesCheckpoint> begun =
      {};  ///< the round to go on from; none: no round is done. Only of lobes.
};

/// The message's bytes: the step's name and, of lobes, the checkpoint.
std::string format_start(const FitStart& start);
/// Throws Error, naming what was found, for other bytes, and as parse_lobes_checkpoint does.
FitStart parse_start(const FileBytes& message);

}  // namespace burnish
