// SPDX-License-Identifier: Apache-2.0
#include <burnish/io/open_source.h>

#include "fuzz_reader.h"

// Parses the content as the format that it appears to be.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions& options) {
    burnish::check_values(burnish::parse_source(file, options).ref());
  });
}
