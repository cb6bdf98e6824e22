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

/// What a file was. Of a surface the source is its mean: one texel of all.
struct Opened {
  Source source;
  std::optional<SurfaceModel> surface;
  std::vector<std::string> entries;  ///< names of what a file of several holds, of which the source is one
};

/// The file as the request's arguments say: "entry" names one of several materials, "decoderAt" says how many bytes are
/// codes of Neural Processes, behind which their decoder stands. Throws Error as the readers do.
Opened open_bytes(FileBytes file, const Json& arguments, const OpenOptions& options);

}  // namespace burnish::wasm
