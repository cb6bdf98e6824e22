// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <burnish/file.h>
#include <burnish/io/open_options.h>
#include <burnish/source.h>
#include <burnish/surface/surface_file.h>

#include "verbs.h"

namespace burnish::wasm {

/// An opened file. The source of a surface is its mean: the one texel of its coarsest level.
struct Opened {
  Source source;
  std::optional<SurfaceModel> surface;
  std::vector<std::string> entries;  ///< names of a file's materials, where several; one is the source
};

/// Opens a file by the request's arguments: "entry" names one of several materials. "decoderAt" is the number of bytes
/// of Neural Processes' codes; their decoder follows. Throws Error as the readers do.
Opened open_bytes(FileBytes file, const Json& arguments, const OpenOptions& options);

}  // namespace burnish::wasm
