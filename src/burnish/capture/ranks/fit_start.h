// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/file.h>

namespace burnish {

/// The steps of a surface's fit that all ranks take.
enum class FitStep { lobes, weights };

/// The first message of rank 0 to the other ranks: the step to begin with. In either case a second message, the
/// checkpoint of rows with the lobes, precedes the weights.
struct FitStart {
  FitStep step = FitStep::lobes;
  std::optional<LobesCheckpoint> begun =
      {};  ///< the round to resume; none: no round is done. Only of step `lobes`.
};

/// Returns the message's bytes: the step's name and, for lobes, the checkpoint.
std::string format_start(const FitStart& start);
/// Throws Error, which names what was found, for other bytes, and as parse_lobes_checkpoint does.
FitStart parse_start(const FileBytes& message);

}  // namespace burnish
